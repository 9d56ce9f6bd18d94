// scenes/expression.cpp - muParser with the functions that scenes want and errors that suggest names.
#include "scenes/expression.h"
#include <cctype>
#include <cmath>
#include <numbers>
#include <vector>
#include <muParser.h>
#include "scenes/diagnostic.h"

namespace skred {
namespace {

mu::Parser make_parser() {
  mu::Parser p;
  p.ClearConst();
  p.EnableOptimizer(false);   // it reorders products: other bits than the expression as written
  p.DefineConst("pi", std::numbers::pi);
  p.DefineConst("deg", std::numbers::pi / 180);
  p.DefineFun("floor", +[](double x) { return std::floor(x); });
  p.DefineFun("ceil", +[](double x) { return std::ceil(x); });
  p.DefineFun("round", +[](double x) { return std::round(x); });
  return p;
}

}  // namespace

double evaluate(const std::string& expression, const std::map<std::string, double>& values) {
  mu::Parser parser = make_parser();
  std::map<std::string, double> own = values;   // muParser can assign to variables
  try {
    for (auto& [name, value] : own) parser.DefineVar(name, &value);
    parser.SetExpr(expression);
    const double result = parser.Eval();
    if (parser.GetNumResults() != 1) throw ExpressionError("an expression has one result; this has several", 0);
    if (!std::isfinite(result)) throw ExpressionError("the expression gives " + std::to_string(result), 0);
    return result;
  } catch (const mu::Parser::exception_type& e) {
    const int position = std::max(0, int(e.GetPos()));
    if (e.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
      std::vector<std::string> known = {"pi", "deg"};
      for (const auto& [name, value] : values) known.push_back(name);
      for (const auto& [name, function] : parser.GetFunDef()) known.push_back(name);
      const std::string best = nearest_name(e.GetToken(), known);
      throw ExpressionError("unknown name '" + e.GetToken() + "' in the expression" +
                                (best.empty() ? "" : "; did you mean '" + best + "'?"), position, e.GetToken());
    }
    throw ExpressionError("in the expression: " + e.GetMsg(), position);
  }
}

bool is_parameter_name(const std::string& name) {
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) return false;
  for (const char c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') return false;
  const mu::Parser parser = make_parser();
  return !parser.GetFunDef().contains(name) && !parser.GetConst().contains(name);
}

}  // namespace skred
