// SPDX-License-Identifier: MIT
// The traversal stack in named vectors of four entries, shifted by selects: a private array is what costs most on
// llvmpipe. Only the first kStackSize entries live, a multiple of four and at least eight; the others are never named,
// and taken out of the text (src/shader/live_text.h). The tree is no deeper than kStackSize, so nothing is ever lost at
// the bottom.

struct Stack {
  ivec4 e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11;  // e0.x: the top
};

/// An empty stack: popping it gives kTraversalDone.
Stack emptyStack() {
  Stack s;
  s.e0 = ivec4(kTraversalDone);
  s.e1 = ivec4(kTraversalDone);
  if (kStackSize > 8) s.e2 = ivec4(kTraversalDone);
  if (kStackSize > 12) s.e3 = ivec4(kTraversalDone);
  if (kStackSize > 16) s.e4 = ivec4(kTraversalDone);
  if (kStackSize > 20) s.e5 = ivec4(kTraversalDone);
  if (kStackSize > 24) s.e6 = ivec4(kTraversalDone);
  if (kStackSize > 28) s.e7 = ivec4(kTraversalDone);
  if (kStackSize > 32) s.e8 = ivec4(kTraversalDone);
  if (kStackSize > 36) s.e9 = ivec4(kTraversalDone);
  if (kStackSize > 40) s.e10 = ivec4(kTraversalDone);
  if (kStackSize > 44) s.e11 = ivec4(kTraversalDone);
  return s;
}

ivec4 pushed(ivec4 e, int top) { return ivec4(top, e.x, e.y, e.z); }
ivec4 popped(ivec4 e, int next) { return ivec4(e.y, e.z, e.w, next); }

/// Pushes value on top, pops the top (e0.x), or neither; never both. Two passes of single selects: nested ones cost
/// llvmpipe a seventh of the time of a ball's paths. A push goes from the bottom up, a pop from the top down, so that
/// each entry is read before it changes.
Stack stepStack(Stack s, bool push, bool pop, int value) {
  if (kStackSize > 44) s.e11 = push ? pushed(s.e11, s.e10.w) : s.e11;
  if (kStackSize > 40) s.e10 = push ? pushed(s.e10, s.e9.w) : s.e10;
  if (kStackSize > 36) s.e9 = push ? pushed(s.e9, s.e8.w) : s.e9;
  if (kStackSize > 32) s.e8 = push ? pushed(s.e8, s.e7.w) : s.e8;
  if (kStackSize > 28) s.e7 = push ? pushed(s.e7, s.e6.w) : s.e7;
  if (kStackSize > 24) s.e6 = push ? pushed(s.e6, s.e5.w) : s.e6;
  if (kStackSize > 20) s.e5 = push ? pushed(s.e5, s.e4.w) : s.e5;
  if (kStackSize > 16) s.e4 = push ? pushed(s.e4, s.e3.w) : s.e4;
  if (kStackSize > 12) s.e3 = push ? pushed(s.e3, s.e2.w) : s.e3;
  if (kStackSize > 8) s.e2 = push ? pushed(s.e2, s.e1.w) : s.e2;
  s.e1 = push ? pushed(s.e1, s.e0.w) : s.e1;
  s.e0 = push ? pushed(s.e0, value) : s.e0;
  s.e0 = pop ? popped(s.e0, s.e1.x) : s.e0;
  s.e1 = pop ? popped(s.e1, (kStackSize > 8 ? s.e2.x : kTraversalDone)) : s.e1;
  if (kStackSize > 8) s.e2 = pop ? popped(s.e2, (kStackSize > 12 ? s.e3.x : kTraversalDone)) : s.e2;
  if (kStackSize > 12) s.e3 = pop ? popped(s.e3, (kStackSize > 16 ? s.e4.x : kTraversalDone)) : s.e3;
  if (kStackSize > 16) s.e4 = pop ? popped(s.e4, (kStackSize > 20 ? s.e5.x : kTraversalDone)) : s.e4;
  if (kStackSize > 20) s.e5 = pop ? popped(s.e5, (kStackSize > 24 ? s.e6.x : kTraversalDone)) : s.e5;
  if (kStackSize > 24) s.e6 = pop ? popped(s.e6, (kStackSize > 28 ? s.e7.x : kTraversalDone)) : s.e6;
  if (kStackSize > 28) s.e7 = pop ? popped(s.e7, (kStackSize > 32 ? s.e8.x : kTraversalDone)) : s.e7;
  if (kStackSize > 32) s.e8 = pop ? popped(s.e8, (kStackSize > 36 ? s.e9.x : kTraversalDone)) : s.e8;
  if (kStackSize > 36) s.e9 = pop ? popped(s.e9, (kStackSize > 40 ? s.e10.x : kTraversalDone)) : s.e9;
  if (kStackSize > 40) s.e10 = pop ? popped(s.e10, (kStackSize > 44 ? s.e11.x : kTraversalDone)) : s.e10;
  if (kStackSize > 44) s.e11 = pop ? popped(s.e11, kTraversalDone) : s.e11;
  return s;
}
