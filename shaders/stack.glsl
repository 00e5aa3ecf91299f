// SPDX-License-Identifier: MIT
// The traversal stack as named scalars, shifted by selects: a private array is what costs most on llvmpipe. Only the
// first kStackSize entries live; the rest are never named, and taken out of the text (src/shader/live_text.h). The tree is no deeper than
// kStackSize, so nothing is ever lost at the bottom.

struct Stack {
  int s0, s1, s2, s3, s4, s5, s6, s7;
  int s8, s9, s10, s11, s12, s13, s14, s15;
  int s16, s17, s18, s19, s20, s21, s22, s23;
  int s24, s25, s26, s27, s28, s29, s30, s31;
  int s32, s33, s34, s35, s36, s37, s38, s39;
  int s40, s41, s42, s43, s44, s45, s46, s47;
};

/// An empty stack: popping it gives kTraversalDone.
Stack emptyStack() {
  Stack s;
  s.s0 = kTraversalDone; s.s1 = kTraversalDone; s.s2 = kTraversalDone; s.s3 = kTraversalDone;
  s.s4 = kTraversalDone; s.s5 = kTraversalDone; s.s6 = kTraversalDone; s.s7 = kTraversalDone;
  if (kStackSize > 8) {
    s.s8 = kTraversalDone; s.s9 = kTraversalDone; s.s10 = kTraversalDone; s.s11 = kTraversalDone;
  }
  if (kStackSize > 12) {
    s.s12 = kTraversalDone; s.s13 = kTraversalDone; s.s14 = kTraversalDone; s.s15 = kTraversalDone;
  }
  if (kStackSize > 16) {
    s.s16 = kTraversalDone; s.s17 = kTraversalDone; s.s18 = kTraversalDone; s.s19 = kTraversalDone;
  }
  if (kStackSize > 20) {
    s.s20 = kTraversalDone; s.s21 = kTraversalDone; s.s22 = kTraversalDone; s.s23 = kTraversalDone;
  }
  if (kStackSize > 24) {
    s.s24 = kTraversalDone; s.s25 = kTraversalDone; s.s26 = kTraversalDone; s.s27 = kTraversalDone;
    s.s28 = kTraversalDone; s.s29 = kTraversalDone; s.s30 = kTraversalDone; s.s31 = kTraversalDone;
  }
  if (kStackSize > 32) {
    s.s32 = kTraversalDone; s.s33 = kTraversalDone; s.s34 = kTraversalDone; s.s35 = kTraversalDone;
    s.s36 = kTraversalDone; s.s37 = kTraversalDone; s.s38 = kTraversalDone; s.s39 = kTraversalDone;
    s.s40 = kTraversalDone; s.s41 = kTraversalDone; s.s42 = kTraversalDone; s.s43 = kTraversalDone;
    s.s44 = kTraversalDone; s.s45 = kTraversalDone; s.s46 = kTraversalDone; s.s47 = kTraversalDone;
  }
  return s;
}

/// Pushes value on top, pops the top (s0), or neither; never both. Two passes of single selects: nested ones cost llvmpipe a seventh of the time of a ball's
/// paths. A push goes from the bottom up, a pop from the top down, so that each entry is read before it changes.
Stack stepStack(Stack s, bool push, bool pop, int value) {
  if (kStackSize > 32) {
    s.s47 = push ? s.s46 : s.s47;
    s.s46 = push ? s.s45 : s.s46;
    s.s45 = push ? s.s44 : s.s45;
    s.s44 = push ? s.s43 : s.s44;
    s.s43 = push ? s.s42 : s.s43;
    s.s42 = push ? s.s41 : s.s42;
    s.s41 = push ? s.s40 : s.s41;
    s.s40 = push ? s.s39 : s.s40;
    s.s39 = push ? s.s38 : s.s39;
    s.s38 = push ? s.s37 : s.s38;
    s.s37 = push ? s.s36 : s.s37;
    s.s36 = push ? s.s35 : s.s36;
    s.s35 = push ? s.s34 : s.s35;
    s.s34 = push ? s.s33 : s.s34;
    s.s33 = push ? s.s32 : s.s33;
    s.s32 = push ? s.s31 : s.s32;
  }
  if (kStackSize > 24) {
    s.s31 = push ? s.s30 : s.s31;
    s.s30 = push ? s.s29 : s.s30;
    s.s29 = push ? s.s28 : s.s29;
    s.s28 = push ? s.s27 : s.s28;
    s.s27 = push ? s.s26 : s.s27;
    s.s26 = push ? s.s25 : s.s26;
    s.s25 = push ? s.s24 : s.s25;
    s.s24 = push ? s.s23 : s.s24;
  }
  if (kStackSize > 20) {
    s.s23 = push ? s.s22 : s.s23;
    s.s22 = push ? s.s21 : s.s22;
    s.s21 = push ? s.s20 : s.s21;
    s.s20 = push ? s.s19 : s.s20;
  }
  if (kStackSize > 16) {
    s.s19 = push ? s.s18 : s.s19;
    s.s18 = push ? s.s17 : s.s18;
    s.s17 = push ? s.s16 : s.s17;
    s.s16 = push ? s.s15 : s.s16;
  }
  if (kStackSize > 12) {
    s.s15 = push ? s.s14 : s.s15;
    s.s14 = push ? s.s13 : s.s14;
    s.s13 = push ? s.s12 : s.s13;
    s.s12 = push ? s.s11 : s.s12;
  }
  if (kStackSize > 8) {
    s.s11 = push ? s.s10 : s.s11;
    s.s10 = push ? s.s9 : s.s10;
    s.s9 = push ? s.s8 : s.s9;
    s.s8 = push ? s.s7 : s.s8;
  }
  s.s7 = push ? s.s6 : s.s7;
  s.s6 = push ? s.s5 : s.s6;
  s.s5 = push ? s.s4 : s.s5;
  s.s4 = push ? s.s3 : s.s4;
  s.s3 = push ? s.s2 : s.s3;
  s.s2 = push ? s.s1 : s.s2;
  s.s1 = push ? s.s0 : s.s1;
  s.s0 = push ? value : s.s0;
  s.s0 = pop ? s.s1 : s.s0;
  s.s1 = pop ? s.s2 : s.s1;
  s.s2 = pop ? s.s3 : s.s2;
  s.s3 = pop ? s.s4 : s.s3;
  s.s4 = pop ? s.s5 : s.s4;
  s.s5 = pop ? s.s6 : s.s5;
  s.s6 = pop ? s.s7 : s.s6;
  s.s7 = pop ? (kStackSize > 8 ? s.s8 : kTraversalDone) : s.s7;
  if (kStackSize > 8) {
    s.s8 = pop ? s.s9 : s.s8;
    s.s9 = pop ? s.s10 : s.s9;
    s.s10 = pop ? s.s11 : s.s10;
    s.s11 = pop ? (kStackSize > 12 ? s.s12 : kTraversalDone) : s.s11;
  }
  if (kStackSize > 12) {
    s.s12 = pop ? s.s13 : s.s12;
    s.s13 = pop ? s.s14 : s.s13;
    s.s14 = pop ? s.s15 : s.s14;
    s.s15 = pop ? (kStackSize > 16 ? s.s16 : kTraversalDone) : s.s15;
  }
  if (kStackSize > 16) {
    s.s16 = pop ? s.s17 : s.s16;
    s.s17 = pop ? s.s18 : s.s17;
    s.s18 = pop ? s.s19 : s.s18;
    s.s19 = pop ? (kStackSize > 20 ? s.s20 : kTraversalDone) : s.s19;
  }
  if (kStackSize > 20) {
    s.s20 = pop ? s.s21 : s.s20;
    s.s21 = pop ? s.s22 : s.s21;
    s.s22 = pop ? s.s23 : s.s22;
    s.s23 = pop ? (kStackSize > 24 ? s.s24 : kTraversalDone) : s.s23;
  }
  if (kStackSize > 24) {
    s.s24 = pop ? s.s25 : s.s24;
    s.s25 = pop ? s.s26 : s.s25;
    s.s26 = pop ? s.s27 : s.s26;
    s.s27 = pop ? s.s28 : s.s27;
    s.s28 = pop ? s.s29 : s.s28;
    s.s29 = pop ? s.s30 : s.s29;
    s.s30 = pop ? s.s31 : s.s30;
    s.s31 = pop ? (kStackSize > 32 ? s.s32 : kTraversalDone) : s.s31;
  }
  if (kStackSize > 32) {
    s.s32 = pop ? s.s33 : s.s32;
    s.s33 = pop ? s.s34 : s.s33;
    s.s34 = pop ? s.s35 : s.s34;
    s.s35 = pop ? s.s36 : s.s35;
    s.s36 = pop ? s.s37 : s.s36;
    s.s37 = pop ? s.s38 : s.s37;
    s.s38 = pop ? s.s39 : s.s38;
    s.s39 = pop ? s.s40 : s.s39;
    s.s40 = pop ? s.s41 : s.s40;
    s.s41 = pop ? s.s42 : s.s41;
    s.s42 = pop ? s.s43 : s.s42;
    s.s43 = pop ? s.s44 : s.s43;
    s.s44 = pop ? s.s45 : s.s44;
    s.s45 = pop ? s.s46 : s.s45;
    s.s46 = pop ? s.s47 : s.s46;
    s.s47 = pop ? kTraversalDone : s.s47;
  }
  return s;
}
