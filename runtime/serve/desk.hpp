#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/outside/outside.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/serve/recording_writer.hpp"

namespace lineshaft {

/// A value as a client gives it.
struct Wanted {
    std::string signal;
    std::string value;       ///< as a program or the language has it: `20 mm`, `true`, `T#2s`
    bool is_number = false;  ///< in the signal's own unit
};

/// `Mode#fast`, `TRUE`, `16#FF`, `T#2s` of Structured Text as a program has such a value; any other
/// text as it is.
std::string as_in_a_program(std::string_view text, const Field& field);

/// Makes changes of what clients want, by the rules of programs. For any thread.
class Desk {
  public:
    explicit Desk(Loaded& loaded) : loaded_(loaded) {}

    /// What is wrong goes to `out`; the changes are usable only when nothing went there.
    std::vector<Change> changes(Change::Kind kind, const std::vector<Wanted>& wanted,
                                Diagnostics& out);

    /// The signals of these names, all of them for none.
    std::vector<const Signal*> signals(const std::vector<std::string>& names, Diagnostics& out);

    /// Whether a client may set the signal, and not only force it.
    bool is_settable(const std::string& signal);

  private:
    static Change change(const Connecting& to, Change::Kind kind, const Wanted& wanted);

    Loaded& loaded_;
    std::mutex mutex_;  ///< the net keeps the units that it has parsed
};

}  // namespace lineshaft
