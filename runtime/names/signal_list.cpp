#include "runtime/names/signal_list.hpp"

namespace lineshaft {

std::vector<std::string> signals_in(std::string_view list) {
    std::vector<std::string> names(1);
    int brackets = 0;
    for (const char c : list) {
        if (c == '[') ++brackets;
        if (c == ']') --brackets;
        if (c != ',' || brackets > 0)
            names.back() += c;
        else
            names.emplace_back();
    }
    std::erase(names, "");
    return names;
}

}  // namespace lineshaft
