#include "runtime/st/syntax/testing.hpp"

#include <algorithm>

namespace lineshaft::st {

TestCall find_test_statement(std::string_view name) {
    const TestStatement* found = find_called(test_statements, name, &TestStatement::name);
    return found ? static_cast<TestCall>(found - test_statements) : TestCall::none;
}

}  // namespace lineshaft::st
