#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runtime/debug/values.hpp"

namespace lineshaft::debug {

/// What an expression comes to, or why it comes to nothing.
struct Evaluated {
    std::string error = {};
    Shown shown = {};
    std::optional<bool> truth = {};  ///< of a BOOL
};

/// An expression of Structured Text that somebody watches: variables that a routine sees, their
/// parts, signals of the program, constants, operators and functions of the standard, as the
/// program reckons with them; of what is the user's it calls GET of a PROPERTY, on a copy. So it
/// changes nothing.
class Expression {
  public:
    /// As in that file.
    Expression(std::string text, const SourceFile& like);
    ~Expression();
    Expression(Expression&&) noexcept;

    const std::string& error() const { return error_; }
    /// The frame outlives what is shown.
    Evaluated value(const Frame& frame) const;
    /// As a variable of that type has it when it is assigned; empty with `error`, if it cannot be.
    std::vector<std::byte> value_for(const st::Type& type, const Frame& frame,
                                     std::string& error) const;

  private:
    struct Parsed;

    std::string text_, error_;
    std::unique_ptr<Parsed> parsed_;
};

}  // namespace lineshaft::debug
