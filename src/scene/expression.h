// An arithmetic expression of a scene, parsed once by muParser, with our own machine-independent functions.
// Names: x y t, pi. Functions: sin cos tan exp log sqrt abs min max floor. Operators: + - * / ^ (whole
// powers), comparisons, && ||, and a < b ? c : d. Copies share one program and may be called from several
// threads.
#pragma once
#include <memory>
#include <string>

namespace smokebox {

class Expression {
 public:
  /// The constant 0.
  Expression();
  explicit Expression(double constant);
  /// `variables`: the names that it may use, a subset of "xyt". Throws std::invalid_argument with a message
  /// for people (what is wrong and near what); the reader adds the place.
  static Expression parse(const std::string& text, const std::string& variables);

  double operator()(double x, double y, double t) const;
  bool isConstant() const;     // uses no variable at all
  bool dependsOnTime() const;  // uses t

 private:
  struct Program;
  std::shared_ptr<const Program> program_;  // empty: the constant
  double constant_ = 0;
};

}  // namespace smokebox
