#pragma once

#include "runtime/run/single_run.hpp"

namespace lineshaft {

/// What makes a run: `program` (the file's name) and its `form` (see Meaning), `parameters` in
/// force, `seed`, and where there are any `controller`, `forces`, `replays` with the hashes of
/// their files. No folders and no times of day: the same run says the same anywhere.
TraceOrigin origin_of(const Loaded& loaded);

}  // namespace lineshaft
