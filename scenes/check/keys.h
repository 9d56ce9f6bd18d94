// scenes/check/keys.h - the keys of the `check` section.
#pragma once
#include "scenes/check/spec.h"
#include "scenes/table.h"

namespace skred {

const Section<CheckSpec>& check_keys();

}  // namespace skred
