#include "scenes/failure.h"
#include <new>
#include "scenes/diagnostic.h"
#include "scenes/errors.h"

namespace skred {

namespace {
template <class E> bool is(const std::exception& e) { return dynamic_cast<const E*>(&e) != nullptr; }
}  // namespace

Failure failure_of(const std::exception& e) {
  const auto named = [](int code, const std::string& what) { return Failure{code, "skred: error: " + what}; };
  if (const auto* told = dynamic_cast<const ToldFailure*>(&e)) return {told->code, told->what()};
  if (is<SceneError>(e)) return {exit_scene, e.what()};                              // has its own places
  if (is<SceneRefused>(e)) return named(exit_scene, e.what());
  if (is<NumericalFailure>(e)) return named(exit_numerical, e.what());
  if (is<UsageError>(e) || is<std::invalid_argument>(e)) return named(exit_usage, e.what());
  if (is<std::bad_alloc>(e)) return named(exit_io, "out of memory: the scene is too large for this machine");
  return named(exit_io, e.what());                                                   // IoError, and what nobody expected
}

}  // namespace skred
