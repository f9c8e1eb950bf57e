#include "scene/expression.h"

#include <muParserBase.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "base/maths.h"
#include "scene/nearest.h"

namespace smokebox {
namespace {

// --- what muParser may call: our functions only, for its own go to the C library
// ----------------------------------------
double squareRoot(double x) { return std::sqrt(x); }
double magnitude(double x) { return std::fabs(x); }
double roundDown(double x) { return std::floor(x); }
double smallest(const double* values, int count) { return *std::min_element(values, values + count); }
double largest(const double* values, int count) { return *std::max_element(values, values + count); }

double add(double a, double b) { return a + b; }
double subtract(double a, double b) { return a - b; }
double multiply(double a, double b) { return a * b; }
double divide(double a, double b) { return a / b; }
double raise(double a, double b) {  // checkExponents() has seen that b is whole
  const bool whole = b == std::floor(b) && std::fabs(b) < 1e9;
  return whole ? exact::power(a, static_cast<long>(b)) : std::numeric_limits<double>::quiet_NaN();
}
double less(double a, double b) { return a < b; }
double greater(double a, double b) { return a > b; }
double atMost(double a, double b) { return a <= b; }
double atLeast(double a, double b) { return a >= b; }
double equal(double a, double b) { return a == b; }
double unequal(double a, double b) { return a != b; }
double both(double a, double b) { return a != 0 && b != 0; }
double either(double a, double b) { return a != 0 || b != 0; }
double negated(double a) { return -a; }
double same(double a) { return a; }

constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
const std::vector<std::string> kFunctions{"sin",  "cos", "tan", "exp", "log",
                                          "sqrt", "abs", "min", "max", "floor"};

/// A parser without muParser's own functions, constants and operators.
class Parser : public mu::ParserBase {
 public:
  Parser() {
    EnableBuiltInOprt(false);
    InitCharSets();
    InitFun();
    InitConst();
    InitOprt();
    AddValIdent(readNumber);
  }
  void InitCharSets() override {
    DefineNameChars("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_");
    DefineOprtChars("+-*/^<>=!&|?:");
    DefineInfixOprtChars("+-");
  }
  void InitFun() override {
    DefineFun("sin", exact::sin);
    DefineFun("cos", exact::cos);
    DefineFun("tan", exact::tan);
    DefineFun("exp", exact::exp);
    DefineFun("log", exact::log);
    DefineFun("sqrt", squareRoot);
    DefineFun("abs", magnitude);
    DefineFun("floor", roundDown);
    DefineFun("min", smallest);
    DefineFun("max", largest);
  }
  void InitConst() override { DefineConst("pi", kPi); }
  void InitOprt() override {
    DefineInfixOprt("-", negated);
    DefineInfixOprt("+", same);
    DefineOprt("||", either, mu::prLOR);
    DefineOprt("&&", both, mu::prLAND);
    DefineOprt("<", less, mu::prCMP);
    DefineOprt(">", greater, mu::prCMP);
    DefineOprt("<=", atMost, mu::prCMP);
    DefineOprt(">=", atLeast, mu::prCMP);
    DefineOprt("==", equal, mu::prCMP);
    DefineOprt("!=", unequal, mu::prCMP);
    DefineOprt("+", add, mu::prADD_SUB);
    DefineOprt("-", subtract, mu::prADD_SUB);
    DefineOprt("*", multiply, mu::prMUL_DIV);
    DefineOprt("/", divide, mu::prMUL_DIV);
    DefineOprt("^", raise, mu::prPOW, mu::oaRIGHT);
  }

 private:
  /// Decimal numbers, by the same rule as tokensOf(): no locale, and `010` is ten.
  static int readNumber(const char* text, int* position, double* value);
};

// --- a look at the text before muParser sees it: names, exponents, near what
// ---------------------------------------------
enum class TokenKind { number, name, open, close, other };

struct Token {
  TokenKind kind;
  std::size_t begin, end;
};

bool digit(char c) { return c >= '0' && c <= '9'; }

/// Length of the decimal number that starts here, 0 if there is none.
std::size_t numberLength(std::string_view text) {
  std::size_t k = 0, digits = 0;
  while (k < text.size() && digit(text[k])) ++k, ++digits;
  if (k < text.size() && text[k] == '.') {
    ++k;
    while (k < text.size() && digit(text[k])) ++k, ++digits;
  }
  if (digits == 0) return 0;
  if (k < text.size() && (text[k] == 'e' || text[k] == 'E')) {
    std::size_t e = k + 1;
    if (e < text.size() && (text[e] == '+' || text[e] == '-')) ++e;
    if (e < text.size() && digit(text[e])) {
      while (e < text.size() && digit(text[e])) ++e;
      k = e;
    }
  }
  return k;
}

double decimal(std::string_view text) {
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) return std::numeric_limits<double>::quiet_NaN();
  return value;
}

int Parser::readNumber(const char* text, int* position, double* value) {
  const std::size_t length = numberLength(text);
  if (length == 0) return 0;
  *value = decimal({text, length});
  *position += static_cast<int>(length);
  return 1;
}

std::vector<Token> tokensOf(const std::string& text) {
  std::vector<Token> tokens;
  for (std::size_t k = 0; k < text.size();) {
    const char c = text[k];
    if (std::isspace(static_cast<unsigned char>(c))) {
      ++k;
      continue;
    }
    std::size_t length = numberLength(std::string_view(text).substr(k));
    TokenKind kind = TokenKind::number;
    if (length == 0) {
      length = 1;
      kind = c == '(' ? TokenKind::open : c == ')' ? TokenKind::close : TokenKind::other;
      if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') {
        kind = TokenKind::name;
        while (k + length < text.size() &&
               (std::isalnum(static_cast<unsigned char>(text[k + length])) || text[k + length] == '_'))
          ++length;
      }
    }
    tokens.push_back({kind, k, k + length});
    k += length;
  }
  return tokens;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  return "`" + std::string(text.substr(0, kLongest)) + (text.size() > kLongest ? "..." : "") + "`";
}

[[noreturn]] void fail(const std::string& what) { throw std::invalid_argument(what); }

/// A power has to be a whole number that stands in the text, such as 2, -3 or (1+1): others need the C
/// library's pow.
void checkExponents(const std::string& text, const std::vector<Token>& tokens) {
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    if (text[tokens[k].begin] != '^') continue;
    std::size_t first = k + 1, last = first;
    while (last < tokens.size() && (text[tokens[last].begin] == '-' || text[tokens[last].begin] == '+'))
      ++last;
    if (last == tokens.size()) continue;  // muParser says what is missing
    if (tokens[last].kind == TokenKind::open) {
      int depth = 1;
      while (depth > 0 && ++last < tokens.size())
        depth += (tokens[last].kind == TokenKind::open) - (tokens[last].kind == TokenKind::close);
      if (depth > 0) continue;
    }
    const std::string exponent = text.substr(tokens[first].begin, tokens[last].end - tokens[first].begin);
    bool whole = tokens[last].kind == TokenKind::number || tokens[last].kind == TokenKind::close;
    for (std::size_t j = first; j <= last; ++j)
      if (tokens[j].kind == TokenKind::name && tokens[j].end - tokens[j].begin == 1)
        whole = false;  // x, y or t
    if (whole) {
      Parser parser;
      parser.SetExpr(exponent);
      const double value = parser.Eval();
      whole = value == std::floor(value) && std::fabs(value) < 1e9;
    }
    if (!whole)
      fail("the power in " + quoted("^" + exponent) +
           " must be a whole number; sqrt, exp and log do the rest");
  }
}

std::string nearText(const std::string& text, int position) {
  const std::size_t at = position < 0 ? text.size() : std::min<std::size_t>(position, text.size());
  if (at >= text.size()) return "at the end of " + quoted(text);
  return "near " + quoted(std::string_view(text).substr(at)) + " in " + quoted(text);
}

std::string explanation(const mu::ParserError& error, const std::string& text) {
  const std::string near = nearText(text, error.GetPos());
  switch (error.GetCode()) {
    case mu::ecMISSING_PARENS:
      return "a parenthesis is not closed in " + quoted(text);
    case mu::ecUNEXPECTED_PARENS:
      return "a parenthesis too many " + near;
    case mu::ecUNEXPECTED_EOF:
      return "something is missing at the end of " + quoted(text);
    case mu::ecUNEXPECTED_OPERATOR:
      return "an operator that does not fit " + near;
    case mu::ecUNEXPECTED_VAL:
      return "a number where an operator was expected, " + near;
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
      return "a name where an operator was expected, " + near;
    case mu::ecUNEXPECTED_ARG_SEP:
      return "a comma that does not fit " + near;
    case mu::ecTOO_MANY_PARAMS:
      return "too many values for a function, " + near;
    case mu::ecTOO_FEW_PARAMS:
      return "too few values for a function, " + near;
    case mu::ecMISPLACED_COLON:
    case mu::ecMISSING_ELSE_CLAUSE:
      return "`?` and `:` do not match in " + quoted(text);
    default:
      return "not an expression " + near;
  }
}

}  // namespace

struct Expression::Program {
  std::string text;
  bool usesPlace = false, usesTime = false;
  // muParser reads its variables from fixed addresses; the lock makes one program safe for many threads.
  mutable std::mutex lock;
  mutable double x = 0, y = 0, t = 0;
  mutable Parser parser;

  double evaluate(double atX, double atY, double atT) const {
    const std::lock_guard<std::mutex> guard(lock);
    x = atX;
    y = atY;
    t = atT;
    return parser.Eval();
  }
};

Expression::Expression() = default;
Expression::Expression(double constant) : constant_(constant) {}

Expression Expression::parse(const std::string& text, const std::string& variables) {
  constexpr std::size_t kLongest = 4000;
  if (text.size() > kLongest)
    fail("an expression of " + std::to_string(text.size()) + " characters is too long");
  const std::vector<Token> tokens = tokensOf(text);
  if (tokens.empty()) fail("an empty expression");

  auto program = std::make_shared<Program>();
  program->text = text;
  std::vector<std::string> known;
  for (char variable : variables) known.emplace_back(1, variable);
  known.emplace_back("pi");
  known.insert(known.end(), kFunctions.begin(), kFunctions.end());
  for (const Token& token : tokens) {
    const std::string word = text.substr(token.begin, token.end - token.begin);
    if (token.kind == TokenKind::name) {
      if (std::find(known.begin(), known.end(), word) == known.end()) {
        std::string message = "unknown name " + quoted(word) + " in " + quoted(text) + "; ";
        if (word == "x" || word == "y" || word == "t") {
          message = quoted(word) + " cannot be used here, in " + quoted(text) + "; ";
          fail(message + suggestion("", known));
        }
        fail(message + suggestion(word, known));
      }
      program->usesPlace |= word == "x" || word == "y";
      program->usesTime |= word == "t";
    } else if (token.kind == TokenKind::other &&
               std::string("+-*/^<>=!&|?:,").find(word) == std::string::npos) {
      fail("a character that does not belong into an expression, " +
           nearText(text, static_cast<int>(token.begin)));
    }
  }

  try {
    checkExponents(text, tokens);
    program->parser.DefineVar("x", &program->x);
    program->parser.DefineVar("y", &program->y);
    program->parser.DefineVar("t", &program->t);
    program->parser.SetExpr(text);
    int results = 0;
    const double* values = program->parser.Eval(results);
    if (results != 1) fail("a comma that does not fit in " + quoted(text));
    if (!program->usesPlace && !program->usesTime) return Expression(values[0]);
  } catch (const mu::ParserError& error) {
    fail(explanation(error, text));
  }
  Expression expression;
  expression.program_ = std::move(program);
  return expression;
}

double Expression::operator()(double x, double y, double t) const {
  return program_ ? program_->evaluate(x, y, t) : constant_;
}

bool Expression::isConstant() const { return !program_; }
bool Expression::dependsOnTime() const { return program_ && program_->usesTime; }

}  // namespace smokebox
