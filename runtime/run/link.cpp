#include "runtime/run/link.hpp"

#include "runtime/net/lay_out.hpp"
#include "runtime/net/outside.hpp"
#include "runtime/net/resolve.hpp"
#include "runtime/scan/expectations.hpp"
#include "runtime/trace/trace_setup.hpp"

namespace lineshaft {

Linked link(const Program& program, const Catalog& catalog, Diagnostics& out) {
    Linked linked;
    linked.net = resolve(program, catalog, out);
    linked.machine = lay_out(linked.net);
    Connecting to{program, linked.net, linked.machine, Reader(out)};
    connect_outside(to);
    linked.traces = connect_traces(to);
    linked.expectations = connect_expectations(to);
    return linked;
}

}  // namespace lineshaft
