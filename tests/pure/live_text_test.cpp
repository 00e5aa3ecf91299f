// SPDX-License-Identifier: MIT
#include <algorithm>

#include <gtest/gtest.h>

#include "shader/assemble.h"
#include "shader/live_text.h"
#include "shader/variant.h"

namespace fragtrace {
namespace {

/// Without the blanks that do not matter here.
std::string live(const std::string& text) {
  std::string left;
  for (const char c : liveText(text)) {
    const bool blank = c == ' ' || c == '\n';
    const bool ends = c == ';' || c == ',' || c == ')';
    if (ends && left.ends_with(' ') && !left.ends_with("{ ") && !left.ends_with("; ")) left.pop_back();
    if (!blank) left += c;
    if (blank && !left.empty() && left.back() != ' ') left += ' ';
  }
  while (left.ends_with(' ')) left.pop_back();
  return left;
}

/// The body of main under two constants.
std::string mainOf(const std::string& body) {
  const std::string head = "const bool kOn = true; const bool kOff = false; const int kSize = 8; ";
  const std::string text = live(head + "void main() { " + body + " }");
  const std::string begin = head + "void main() { ";
  EXPECT_TRUE(text.starts_with(begin)) << text;
  const std::string rest = text.substr(begin.size());
  return rest.substr(0, rest.size() - (rest == "}" ? 1 : 2));
}

TEST(LiveText, BranchesThatConstantsSettle) {
  EXPECT_EQ(mainOf("if (kOn) a(); b();"), "a(); b();");
  EXPECT_EQ(mainOf("if (kOff) a(); b();"), "b();");
  EXPECT_EQ(mainOf("if (kOff) { a(); } else { b(); }"), "{ b(); }");
  EXPECT_EQ(mainOf("if (kOn) { a(); } else if (x) b(); else c();"), "{ a(); }");
  EXPECT_EQ(mainOf("if (x) if (kOff) a(); else b();"), "if (x) b();");
  EXPECT_EQ(mainOf("if (x) if (kOff) { a(); } c();"), "if (x) { } c();");
  EXPECT_EQ(mainOf("if (kOff) for (;;) { a(); } c();"), "c();");
  EXPECT_EQ(mainOf("if (x) { b(); } else if (kOff) a();"), "if (x) { b(); } else;");
  EXPECT_EQ(mainOf("for (;;) if (kOff) a();"), "for (;;);");
  EXPECT_EQ(mainOf("while (kOff && x) { a(); }"), "");
  EXPECT_EQ(mainOf("if (x) { if (kOn) return; a(); } b();"), "if (x) { return; } b();");
  EXPECT_EQ(mainOf("if (x) if (kOn) return; a();"), "if (x) return; a();");
  EXPECT_EQ(mainOf("if (x) a(); else if (kOn) return; b();"), "if (x) a(); else return; b();");
  EXPECT_EQ(mainOf("while (kOn) { a(); }"), "while (kOn) { a(); }");
}

TEST(LiveText, ConditionsOfSeveralParts) {
  EXPECT_EQ(mainOf("if (x && !kOn) a();"), "");
  EXPECT_EQ(mainOf("if (x || kOn) a();"), "a();");
  EXPECT_EQ(mainOf("if (kOff || (kSize > 8 && kOn)) a();"), "");
  EXPECT_EQ(mainOf("if (kSize == 8 && !(kOff || false)) a();"), "a();");
  EXPECT_EQ(mainOf("if (x && kOn) a();"), "if (x && kOn) a();");
}

TEST(LiveText, CallsOfFunctionsWhoseResultIsKnown) {
  const std::string head =
      "const bool kOff = false; int n; bool never(int a) { return kOff && a > n; } "
      "bool maybe(int a) { return kOff || a > n; } bool acts(int a) { n = a; return kOff; } ";
  const auto after = [&](const std::string& body) {
    const std::string text = live(head + "void main() { " + body + " }");
    return text.substr(text.find("main() {") + 9);
  };
  EXPECT_EQ(after("if (never(2)) a(); b();"), "b(); }");
  EXPECT_EQ(after("if (!never(x)) a();"), "a(); }");
  EXPECT_EQ(after("y = x && never(1) ? 1 : 2;"), "y = 2; }");
  EXPECT_EQ(after("if (never(acts(1) ? 1 : 2)) a();"), "if (never(acts(1) ? 1 : 2)) a(); }");
  EXPECT_EQ(after("if (maybe(2)) a();"), "if (maybe(2)) a(); }");
  EXPECT_EQ(after("if (acts(2)) a();"), "if (acts(2)) a(); }");
}

TEST(LiveText, WhatMayActInAConditionStays) {
  for (const char* body :
       {"if (f(x) && kOff) a();", "if (x++ > 1 || kOn) a();", "if ((x = y) > 1 && kOff) a();"})
    EXPECT_EQ(mainOf(body), body);
  EXPECT_EQ(mainOf("if (kOff && f(x)) a();"), "");
}

TEST(LiveText, Choices) {
  EXPECT_EQ(mainOf("x = kOn ? a : b;"), "x = a;");
  EXPECT_EQ(mainOf("x = kOff ? a : b;"), "x = b;");
  EXPECT_EQ(mainOf("f(kOff ? a : b, kOn ? p ? q : r : s);"), "f( b, p ? q : r);");
  EXPECT_EQ(mainOf("x = c ? kOff ? a : b : d;"), "x = c ? b : d;");
  EXPECT_EQ(mainOf("x = c ? d : kSize > 8 ? a : b;"), "x = c ? d : b;");
  EXPECT_EQ(mainOf("x = y + kOn ? a : b;"), "x = y + kOn ? a : b;");
  EXPECT_EQ(mainOf("x = f(y) && kOff ? a : b;"), "x = f(y) && kOff ? a : b;");
}

TEST(LiveText, FunctionsThatNothingCalls) {
  EXPECT_EQ(live("int f() { return 1; } int g() { return f(); } int x = 2; void main() { }"),
            "int x = 2; void main() { }");
  EXPECT_EQ(live("int f() { return 1; } int x = f(); void main() { }"),
            "int f() { return 1; } int x = f(); void main() { }");
  EXPECT_EQ(live("const bool k = false; void f() { } void main() { if (k) f(); }"),
            "const bool k = false; void main() { }");
}

TEST(LiveText, LinesKeepTheirNumbers) {
  const std::string text =
      "const bool kOff = false;  // one\n/* two\n */ void f() {\n}\n#line 9\nvoid main() {\n  if (kOff) {\n  "
      "  f();\n  }\n  wrong;\n}\n";
  const std::string left = liveText(text);
  const auto lineOf = [](const std::string& all, const char* word) {
    return std::count(all.begin(), all.begin() + long(all.find(word)), '\n');
  };
  for (const char* word : {"#line 9\n", "main", "wrong"}) EXPECT_EQ(lineOf(left, word), lineOf(text, word));
  EXPECT_EQ(left.find("f()"), std::string::npos);
}

TEST(LiveText, ForPeopleHasTheCommentsOnWhatIsLeft) {
  EXPECT_EQ(
      readableText(
          "const bool kOff = false;  // one\n\n/// Not called.\nvoid f() {}\n\n/// Two\n/// lines.\nvoid "
          "main() {\n  // Three.\n  if (kOff) f();  // never\n  if (!kOff) a();  // four\n}\n"),
      "const bool kOff = false;  // one\n\n/// Two\n/// lines.\nvoid main() {\n  a();  // four\n}\n");
  const auto names = [](const std::string& text) {
    std::vector<std::string> found;
    for (const Token& token : tokensOf(text))
      if (token.text[0] != '#') found.emplace_back(token.text);
    return found;
  };
  ShaderVariant variant;
  variant.stages = stagesUpTo(Stage::Gi);
  EXPECT_EQ(names(readableShader({}, "entry/trace.frag", variant)),
            names(assembleShader({}, "entry/trace.frag", variant)));
}

TEST(LiveText, TextThatIsNotUnderstoodStaysAsItIs) {
  for (const char* text : {"void main() { if (a }", "", "const bool k = false; void main() { if (k) a(); ))"})
    EXPECT_EQ(liveText(text), text);
}

TEST(LiveText, AVariantHasNothingOfWhatItIsWithout) {
  const std::string text = assembleShader({}, "entry/trace.frag", ShaderVariant{});
  for (const char* name : {"sheenLambda", "savePath", "s.e3", "perlin("})
    EXPECT_EQ(text.find(name), std::string::npos) << name;
  EXPECT_NE(text.find("void main()"), std::string::npos);
}

}  // namespace
}  // namespace fragtrace
