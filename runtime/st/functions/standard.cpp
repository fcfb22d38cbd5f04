#include "runtime/st/functions/standard.hpp"

#include <vector>

#include <fmt/format.h>

namespace lineshaft::st {

std::span<const StandardFunction* const> standard_functions() {
    static const std::vector<const StandardFunction*> all = [] {
        std::vector<const StandardFunction*> rows;
        for (const Subject* subject : function_subjects)
            for (const StandardFunction& row : subject->functions) rows.push_back(&row);
        return rows;
    }();
    return all;
}

const StandardFunction* find_standard_function(std::string_view name) {
    static const NameMap<const StandardFunction*> by_name = [] {
        NameMap<const StandardFunction*> made;
        for (const StandardFunction* f : standard_functions()) made.emplace(f->name, f);
        return made;
    }();
    return find_in(by_name, name);
}

/// Those behind the row's last one are counted on from it: IN1, IN2, IN3.
std::string argument_name(const StandardFunction& function, int argument) {
    const std::string_view name = function.parameter(static_cast<std::size_t>(argument)).name;
    const int more = argument - (function.least - 1);
    if (more <= 0) return std::string(name);
    return fmt::format("{}{}", name.substr(0, name.size() - 1), name.back() - '0' + more);
}

}  // namespace lineshaft::st
