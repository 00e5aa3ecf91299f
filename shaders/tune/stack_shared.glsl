// SPDX-License-Identifier: MIT
// The traversal stack for compute on GPUs, with the functions of stack_text.h. Entries lie in shared memory, so a stack
// takes one register. Each lane has one stack, so only one of its traversals may be in progress.

const int kGroupLanes = 64;  // size of all compute entries' groups

shared uint stackEntries[kStackSize * kGroupLanes];  // each entry has a row of all lanes

struct Stack {
  int count;
};

int stackPlace(int entry) { return entry * kGroupLanes + int(gl_LocalInvocationIndex); }

Stack emptyStack() { return Stack(0); }

uint topOf(Stack s) { return s.count > 0 ? stackEntries[stackPlace(s.count - 1)] : kEndGroup; }

Stack stepStack(Stack s, bool push, bool pop, uint value) {
  if (push) stackEntries[stackPlace(s.count)] = value;
  return Stack(s.count + (push ? 1 : pop && s.count > 0 ? -1 : 0));
}
