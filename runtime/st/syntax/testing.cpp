#include "runtime/st/syntax/testing.hpp"

#include <algorithm>

#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

TestCall find_test_statement(std::string_view name) {
    const auto* it = std::ranges::find_if(
        test_statements, [&](const TestStatement& known) { return same_name(known.name, name); });
    if (it == std::end(test_statements)) return TestCall::none;
    return static_cast<TestCall>(it - std::begin(test_statements));
}

}  // namespace lineshaft::st
