#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/debug/evaluation.hpp"
#include "runtime/st/library/kind.hpp"

namespace lineshaft::debug {

/// Where somebody wants to stop, and when.
struct Wanted {
    int line = 0;
    std::string condition = {};  ///< an expression; empty: always
    std::string hits = {};       ///< `3`: the third time; `>= 3`, `> 3`, `% 3`; empty: each time
    std::string log =
        {};  ///< told instead of stopping: `speed is {speed}`, and `{{` for a '{'; empty: it stops
};

/// How often it must have been come to.
struct HitCount {
    enum class Is : std::uint8_t { equal, at_least, above, multiple };
    Is is = Is::equal;
    std::int64_t number = 1;

    bool holds(std::int64_t count) const;
};

struct Breakpoint {
    int id = 0;
    int line = 0;  ///< with code, or as it was wanted
    bool is_verified = false;
    std::string path = {};                             ///< of the file
    std::shared_ptr<const SourceFile> file = nullptr;  ///< that; null: no code is there
    Wanted wanted = {};
    std::string error = {};  ///< why it is none
    std::shared_ptr<const Expression> condition = {};
    std::optional<HitCount> hits = {};
    /// Text, and what is put in behind it; or null.
    std::vector<std::pair<std::string, std::shared_ptr<const Expression>>> log = {};

    std::string logged(const Frame& frame) const;
};

/// Breakpoints at lines of Structured Text.
class Breakpoints {
  public:
    /// Null: there is no Structured Text.
    explicit Breakpoints(const st::Library::Made* made);

    /// In place of those that the file had. One that is at a line without code is at the next line
    /// that has some.
    std::vector<Breakpoint> set(const std::string& path, const std::vector<Wanted>& wanted);

    bool empty() const { return count_ == 0; }

    /// Whether one asks how often it has been come to.
    bool are_counted() const;

    /// Those before a statement, by its number.
    const std::vector<const Breakpoint*>& at(std::size_t statement) const { return at_[statement]; }

    /// Whether a scan that begins with the routine may come to one.
    bool are_reached_by(const st::CodeRoutine& routine) const {
        return reached_[static_cast<std::size_t>(&routine - routines_)];
    }

  private:
    struct Line {
        std::string path;
        std::shared_ptr<const SourceFile> file;
        int line = 0;
    };

    void arrange();
    bool place(Breakpoint& breakpoint) const;

    const st::Library::Made* made_;
    const st::CodeRoutine* routines_ = nullptr;
    std::vector<Line> lines_;  ///< of each statement
    std::vector<Breakpoint> breakpoints_;
    std::vector<std::vector<const Breakpoint*>> at_;
    std::vector<bool> reached_;  ///< from each routine
    std::size_t count_ = 0;
    int last_id_ = 0;
};

}  // namespace lineshaft::debug
