#include "blocks/logic/edge.hpp"

#include "blocks/inputs.hpp"

namespace lineshaft {

template <bool falling>
std::span<const Field> Edge<falling>::fields() {
    using E = Edge;
    static const Field table[] = {
        input("clk", &E::clk, "", "signal to watch").must_be_set(),
        output("q", &E::q, "", falling ? "clk has fallen" : "clk has risen"),
        local("last", &E::last, "", falling ? "clk was false" : "clk was true"),
    };
    return table;
}

template <bool falling>
void Edge<falling>::scan(const Scan&) {
    q = rising_edge(clk != falling, last);
}

template struct Edge<false>;
template struct Edge<true>;

}  // namespace lineshaft
