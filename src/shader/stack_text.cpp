// SPDX-License-Identifier: MIT
#include "shader/stack_text.h"

namespace fragtrace {

namespace {

/// Member i of a stack.
std::string member(int i) { return "s.e" + std::to_string(i); }

/// A statement about vector i. The first two always live.
std::string line(int i, const std::string& statement) {
  const std::string condition = i < 2 ? "" : "if (kStackSize > " + std::to_string(4 * i) + ") ";
  return "  " + condition + statement + ";\n";
}

std::string pushLine(int i) {
  const std::string e = member(i);
  const std::string from = i == 0 ? "value" : member(i - 1) + ".w";
  return line(i, e + " = mix(" + e + ", pushed(" + e + ", " + from + "), bvec4(push))");
}

std::string popLine(int i, int vectors) {
  const std::string e = member(i);
  std::string next = "kEndGroup";
  if (i + 1 < vectors) {
    next = member(i + 1) + ".x";
    if (i > 0) next = "(kStackSize > " + std::to_string(4 * i + 4) + " ? " + next + " : kEndGroup)";
  }
  return line(i, e + " = mix(" + e + ", popped(" + e + ", " + next + "), bvec4(pop))");
}

}  // namespace

std::string stackText(int vectors) {
  std::string text = "// Made by src/shader/stack_text.cpp.\nstruct Stack {\n";
  for (int i = 0; i < vectors; ++i) text += "  uvec4 e" + std::to_string(i) + ";\n";
  text += "};\n";
  // An empty stack: popping it gives kEndGroup.
  text += "Stack emptyStack() {\n  Stack s;\n";
  for (int i = 0; i < vectors; ++i) text += line(i, member(i) + " = uvec4(kEndGroup)");
  text += "  return s;\n}\n";
  text += "uint topOf(Stack s) { return s.e0.x; }\n";
  text += "uvec4 pushed(uvec4 e, uint top) { return uvec4(top, e.x, e.y, e.z); }\n";
  text += "uvec4 popped(uvec4 e, uint next) { return uvec4(e.y, e.z, e.w, next); }\n";
  // Pushes value on top, pops the top (e0.x), or neither; never both. Two passes of single selects: nested
  // ones cost llvmpipe a seventh of the time of a ball's paths. A push goes from the bottom up, a pop from
  // the top down, so that each entry is read before it changes.
  text += "Stack stepStack(Stack s, bool push, bool pop, uint value) {\n";
  for (int i = vectors; i-- > 0;) text += pushLine(i);
  for (int i = 0; i < vectors; ++i) text += popLine(i, vectors);
  return text + "  return s;\n}\n";
}

std::string stackRowsText(int vectors) {
  std::string save = "void saveStack(Stack s, int r) {\n";
  std::string load = "Stack loadStack(int r) {\n  Stack s = emptyStack();\n";
  for (int i = 0; i < vectors; ++i) {
    const std::string row = i == 0 ? "r" : "r + " + std::to_string(i);
    save += line(i, "pathStates[" + row + "] = " + member(i));
    load += line(i, member(i) + " = readPathStates(" + row + ")");
  }
  return save + "}\n" + load + "  return s;\n}\n";
}

}  // namespace fragtrace
