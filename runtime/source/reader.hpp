#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/source/units.hpp"
#include "runtime/source/yaml.hpp"

namespace lineshaft {

/// Reads checked values out of nodes; what is wrong becomes a diagnostic at the node's place.
/// Every function returns nothing, or a harmless default, after reporting. Nothing is reported of
/// an unknown parameter, for that has been already.
class Reader {
  public:
    explicit Reader(Diagnostics& out) : out_(out) {}

    /// Reports it at `node`. Where the text there is an expression, or has a character that only
    /// looks like the one that is meant, that is what is reported (L0109, L0217).
    void fail(const char* code, const Node& node, std::string message, std::string help = {}) const;

    /// L0209 unless it is one.
    bool expect_map(const Node& node, std::string_view what, std::string help = {}) const;
    bool expect_sequence(const Node& node, std::string_view what, std::string help = {}) const;
    bool expect_scalar(const Node& node, std::string_view what) const;

    /// Letters, digits and underscores, not starting with a digit; L0210 otherwise.
    bool identifier(const Node& node, std::string_view what) const;

    std::optional<bool> boolean(const Node& node) const;
    /// A number of 64 bits, with or without a sign. `help` is for one with a unit.
    std::optional<Wide> whole(const Node& node, std::string help = {}) const;
    /// Likewise, of those with a sign.
    std::optional<std::int64_t> integer(const Node& node, std::string help = {}) const;
    /// `expected` is what is wanted instead of something that is no number, for the message.
    std::optional<Quantity> quantity(const Node& node, std::string expected = {}) const;

    /// A quantity in `unit`: L0302 when the unit is missing, L0303 when it measures something else.
    std::optional<double> real(const Node& node, const Unit& unit) const;

    /// A quantity in `unit`, or a percentage of the size of `whole`.
    std::optional<double> real_or_share(const Node& node, const Unit& unit, double whole) const;

    /// Whole nanoseconds, not negative.
    std::optional<std::int64_t> time(const Node& node) const;

    /// A time, or a percentage of `whole` [ns].
    std::optional<std::int64_t> time_or_share(const Node& node, std::int64_t whole) const;

    Diagnostics& diagnostics() const { return out_; }

  private:
    Diagnostics& out_;
};

/// `5 %`
bool is_share(const Node& node);

/// A unit that a plain number has as well: none, `mm/mm`.
bool is_plain(const Unit& unit);

bool is_identifier(std::string_view text);

/// `shaft.position` taken apart.
struct SignalName {
    std::string_view owner;  ///< a block, `inputs` or `outputs`
    std::string_view port;
};

/// Empty unless the text is two identifiers with a dot between.
std::optional<SignalName> split_signal(std::string_view text);

}  // namespace lineshaft
