#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "runtime/model/value.hpp"

namespace lineshaft {

/// A value by number: a field of an instance, or an input of the program.
struct Port {
    int instance = -1;  ///< -1: an input of the program
    int field = -1;     ///< of the instance's type, or number of the input
};

/// A named value that can be traced, expected, compared: as the world outside its task sees it.
struct Signal {
    std::string name;  ///< `shaft.position`, `inputs.start`
    Type type = Type::real;
    std::string unit;
    ValueNames names;                 ///< of an enumeration
    const std::byte* slot = nullptr;  ///< null until it is laid out
    int task = -1;                    ///< index of the task that writes it; -1: from outside
    Port port = {};

    bool is_time() const { return lineshaft::is_time(type, unit); }
    Value value() const { return load(type, slot); }
    std::string describe(const Value& v) const { return lineshaft::describe(v, type, names, unit); }
};

}  // namespace lineshaft
