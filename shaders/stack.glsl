// SPDX-License-Identifier: MIT
// The traversal stack as named scalars, shifted by selects: a private array is what costs most on llvmpipe. Only the
// first kStackSize entries live; the rest are never read, and the compiler drops them. The tree is no deeper than
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
  s.s8 = kTraversalDone; s.s9 = kTraversalDone; s.s10 = kTraversalDone; s.s11 = kTraversalDone;
  s.s12 = kTraversalDone; s.s13 = kTraversalDone; s.s14 = kTraversalDone; s.s15 = kTraversalDone;
  s.s16 = kTraversalDone; s.s17 = kTraversalDone; s.s18 = kTraversalDone; s.s19 = kTraversalDone;
  s.s20 = kTraversalDone; s.s21 = kTraversalDone; s.s22 = kTraversalDone; s.s23 = kTraversalDone;
  s.s24 = kTraversalDone; s.s25 = kTraversalDone; s.s26 = kTraversalDone; s.s27 = kTraversalDone;
  s.s28 = kTraversalDone; s.s29 = kTraversalDone; s.s30 = kTraversalDone; s.s31 = kTraversalDone;
  s.s32 = kTraversalDone; s.s33 = kTraversalDone; s.s34 = kTraversalDone; s.s35 = kTraversalDone;
  s.s36 = kTraversalDone; s.s37 = kTraversalDone; s.s38 = kTraversalDone; s.s39 = kTraversalDone;
  s.s40 = kTraversalDone; s.s41 = kTraversalDone; s.s42 = kTraversalDone; s.s43 = kTraversalDone;
  s.s44 = kTraversalDone; s.s45 = kTraversalDone; s.s46 = kTraversalDone; s.s47 = kTraversalDone;
  return s;
}

/// Pushes value on top, pops the top (s0), or neither; never both.
Stack stepStack(Stack s, bool push, bool pop, int value) {
  Stack t = s;
  s.s0 = push ? value : (pop ? t.s1 : t.s0);
  s.s1 = push ? t.s0 : (pop ? t.s2 : t.s1);
  s.s2 = push ? t.s1 : (pop ? t.s3 : t.s2);
  s.s3 = push ? t.s2 : (pop ? t.s4 : t.s3);
  s.s4 = push ? t.s3 : (pop ? t.s5 : t.s4);
  s.s5 = push ? t.s4 : (pop ? t.s6 : t.s5);
  s.s6 = push ? t.s5 : (pop ? t.s7 : t.s6);
  s.s7 = push ? t.s6 : (pop ? (kStackSize > 8 ? t.s8 : kTraversalDone) : t.s7);
  if (kStackSize > 8) {
    s.s8 = push ? t.s7 : (pop ? t.s9 : t.s8);
    s.s9 = push ? t.s8 : (pop ? t.s10 : t.s9);
    s.s10 = push ? t.s9 : (pop ? t.s11 : t.s10);
    s.s11 = push ? t.s10 : (pop ? (kStackSize > 12 ? t.s12 : kTraversalDone) : t.s11);
  }
  if (kStackSize > 12) {
    s.s12 = push ? t.s11 : (pop ? t.s13 : t.s12);
    s.s13 = push ? t.s12 : (pop ? t.s14 : t.s13);
    s.s14 = push ? t.s13 : (pop ? t.s15 : t.s14);
    s.s15 = push ? t.s14 : (pop ? (kStackSize > 16 ? t.s16 : kTraversalDone) : t.s15);
  }
  if (kStackSize > 16) {
    s.s16 = push ? t.s15 : (pop ? t.s17 : t.s16);
    s.s17 = push ? t.s16 : (pop ? t.s18 : t.s17);
    s.s18 = push ? t.s17 : (pop ? t.s19 : t.s18);
    s.s19 = push ? t.s18 : (pop ? (kStackSize > 20 ? t.s20 : kTraversalDone) : t.s19);
  }
  if (kStackSize > 20) {
    s.s20 = push ? t.s19 : (pop ? t.s21 : t.s20);
    s.s21 = push ? t.s20 : (pop ? t.s22 : t.s21);
    s.s22 = push ? t.s21 : (pop ? t.s23 : t.s22);
    s.s23 = push ? t.s22 : (pop ? (kStackSize > 24 ? t.s24 : kTraversalDone) : t.s23);
  }
  if (kStackSize > 24) {
    s.s24 = push ? t.s23 : (pop ? t.s25 : t.s24);
    s.s25 = push ? t.s24 : (pop ? t.s26 : t.s25);
    s.s26 = push ? t.s25 : (pop ? t.s27 : t.s26);
    s.s27 = push ? t.s26 : (pop ? t.s28 : t.s27);
    s.s28 = push ? t.s27 : (pop ? t.s29 : t.s28);
    s.s29 = push ? t.s28 : (pop ? t.s30 : t.s29);
    s.s30 = push ? t.s29 : (pop ? t.s31 : t.s30);
    s.s31 = push ? t.s30 : (pop ? (kStackSize > 32 ? t.s32 : kTraversalDone) : t.s31);
  }
  if (kStackSize > 32) {
    s.s32 = push ? t.s31 : (pop ? t.s33 : t.s32);
    s.s33 = push ? t.s32 : (pop ? t.s34 : t.s33);
    s.s34 = push ? t.s33 : (pop ? t.s35 : t.s34);
    s.s35 = push ? t.s34 : (pop ? t.s36 : t.s35);
    s.s36 = push ? t.s35 : (pop ? t.s37 : t.s36);
    s.s37 = push ? t.s36 : (pop ? t.s38 : t.s37);
    s.s38 = push ? t.s37 : (pop ? t.s39 : t.s38);
    s.s39 = push ? t.s38 : (pop ? t.s40 : t.s39);
    s.s40 = push ? t.s39 : (pop ? t.s41 : t.s40);
    s.s41 = push ? t.s40 : (pop ? t.s42 : t.s41);
    s.s42 = push ? t.s41 : (pop ? t.s43 : t.s42);
    s.s43 = push ? t.s42 : (pop ? t.s44 : t.s43);
    s.s44 = push ? t.s43 : (pop ? t.s45 : t.s44);
    s.s45 = push ? t.s44 : (pop ? t.s46 : t.s45);
    s.s46 = push ? t.s45 : (pop ? t.s47 : t.s46);
    s.s47 = push ? t.s46 : (pop ? kTraversalDone : t.s47);
  }
  return s;
}
