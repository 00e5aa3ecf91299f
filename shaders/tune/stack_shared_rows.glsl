// SPDX-License-Identifier: MIT
// Stores a stack in shared memory in rows of the buffer of path states, in the layout of vectors: from the top down,
// then kEndGroup.

uint entryOf(Stack s, int depth) {
  return depth < s.count ? stackEntries[stackPlace(s.count - 1 - depth)] : kEndGroup;
}

void saveStack(Stack s, int row) {
  for (int i = 0; i < kStackSize; i += 4) {
    pathStates[row + i / 4] = uvec4(entryOf(s, i), entryOf(s, i + 1), entryOf(s, i + 2), entryOf(s, i + 3));
  }
}

Stack loadStack(int row) {
  Stack s = emptyStack();
  for (int i = kStackSize - 4; i >= 0; i -= 4) {
    uvec4 entries = readPathStates(row + i / 4);
    for (int k = 3; k >= 0; --k) s = stepStack(s, entries[k] != kEndGroup, false, entries[k]);
  }
  return s;
}
