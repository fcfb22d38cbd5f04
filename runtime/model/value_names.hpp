#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/source/wide.hpp"

namespace lineshaft {

/// What an enumeration's numbers are called. As a list it is the names.
class ValueNames {
  public:
    constexpr ValueNames() = default;
    /// The numbers are 0, 1, 2, ..., which are written as names alone.
    constexpr ValueNames(std::span<const std::string_view> names) : names_(names) {}
    /// Each name has one of these numbers, which are written, too; names may share one. `type` is
    /// what the enumeration is called.
    constexpr ValueNames(std::string_view type, std::span<const std::string_view> names,
                         std::span<const std::int64_t> numbers)
        : type_(type), names_(names), numbers_(numbers) {}

    constexpr auto begin() const { return names_.begin(); }
    constexpr auto end() const { return names_.end(); }
    constexpr std::size_t size() const { return names_.size(); }
    constexpr bool empty() const { return names_.empty(); }
    constexpr std::string_view front() const { return names_.front(); }
    constexpr std::string_view operator[](std::size_t place) const { return names_[place]; }
    std::vector<std::string_view> list() const { return {begin(), end()}; }

    /// Numbers from `least` to `most` without a name are values, too.
    constexpr ValueNames with_others(std::int64_t least, std::int64_t most) const {
        ValueNames made = *this;
        made.least_ = least;
        made.most_ = most;
        return made;
    }

    /// Numbers are stored as 64 bits without a sign: those from 2^63 on are values, too.
    constexpr ValueNames without_sign() const {
        ValueNames made = *this;
        made.has_sign_ = false;
        return made;
    }

    constexpr bool has_sign() const { return has_sign_; }
    /// What a stored number counts.
    constexpr Wide whole(std::int64_t stored) const {
        return has_sign_ ? Wide{stored} : Wide{static_cast<std::uint64_t>(stored)};
    }
    /// How a number is stored; empty where 64 bits cannot hold it.
    constexpr std::optional<std::int64_t> stored(Wide number) const {
        const auto bits = static_cast<std::int64_t>(number);
        return whole(bits) == number ? std::optional(bits) : std::nullopt;
    }

    constexpr std::string_view type() const { return type_; }
    constexpr bool may_be_written_as_numbers() const { return !numbers_.empty(); }
    /// The number that the name at `place` is stored as.
    constexpr std::int64_t number(std::size_t place) const {
        return numbers_.empty() ? static_cast<std::int64_t>(place) : numbers_[place];
    }
    /// What they count where they are not 0, 1, 2, ...; else none.
    std::vector<Wide> odd_numbers() const {
        std::vector<Wide> counted;
        bool is_odd = false;
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            counted.push_back(whole(numbers_[i]));
            is_odd = is_odd || counted[i] != static_cast<Wide>(i);
        }
        return is_odd ? counted : std::vector<Wide>();
    }
    /// Empty: none is called so.
    constexpr std::optional<std::int64_t> find(std::string_view name) const {
        const auto it = std::ranges::find(names_, name);
        if (it == names_.end()) return {};
        return number(static_cast<std::size_t>(it - names_.begin()));
    }
    /// The first name that the number has; empty: it has none.
    constexpr std::string_view of(std::int64_t value) const {
        for (std::size_t i = 0; i < names_.size(); ++i)
            if (number(i) == value) return names_[i];
        return {};
    }
    constexpr bool takes(std::int64_t value) const {
        if (value >= least_ && value <= most_) return true;
        for (std::size_t i = 0; i < names_.size(); ++i)
            if (number(i) == value) return true;
        return false;
    }
    /// Whether each value is one of the other, under the same names.
    bool fits(const ValueNames& other) const {
        if (!std::ranges::equal(names_, other.names_) || has_sign_ != other.has_sign_) return false;
        for (std::size_t i = 0; i < names_.size(); ++i)
            if (number(i) != other.number(i)) return false;
        return least_ > most_ || (least_ >= other.least_ && most_ <= other.most_);
    }

  private:
    std::string_view type_;
    std::span<const std::string_view> names_;
    std::span<const std::int64_t> numbers_;
    std::int64_t least_ = 0, most_ = -1;
    bool has_sign_ = true;
};

}  // namespace lineshaft
