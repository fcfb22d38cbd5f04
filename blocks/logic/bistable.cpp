#include "blocks/logic/bistable.hpp"

namespace lineshaft {

std::span<const Field> Sr::fields() {
    static const Field table[] = {
        input("s1", &Sr::s1, "", "set; wins over r").must_be_set(),
        input("r", &Sr::r, "", "reset").must_be_set(),
        output("q1", &Sr::q1, "", "set, and not reset since"),
    };
    return table;
}

void Sr::scan(const Scan&) {
    q1 = s1 || (!r && q1);
}

std::span<const Field> Rs::fields() {
    static const Field table[] = {
        input("s", &Rs::s, "", "set").must_be_set(),
        input("r1", &Rs::r1, "", "reset; wins over s").must_be_set(),
        output("q1", &Rs::q1, "", "set, and not reset since"),
    };
    return table;
}

void Rs::scan(const Scan&) {
    q1 = !r1 && (s || q1);
}

}  // namespace lineshaft
