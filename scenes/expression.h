// scenes/expression.h - arithmetic on a scene's parameters, by muParser.
#pragma once
#include <map>
#include <stdexcept>
#include <string>

namespace skred {

struct ExpressionError : std::runtime_error {
  ExpressionError(const std::string& message, int at, std::string name = "")
      : std::runtime_error(message), position(at), unknown(std::move(name)) {}
  int position;          // in the expression, from 0
  std::string unknown;   // the name that has no value, if that is the reason
};

// "sqrt(2) * a / 10" with the given values of names. + - * / ^, comparisons and ?:, sqrt, sin, min, max, floor, ceil, ...;
// pi, and deg = pi/180. Angles in radians. Throws ExpressionError, also where the result is not a finite number.
double evaluate(const std::string& expression, const std::map<std::string, double>& values);

// Whether a parameter may have this name: a letter, then letters, digits and '_', and not a function's or constant's name.
bool is_parameter_name(const std::string& name);

}  // namespace skred
