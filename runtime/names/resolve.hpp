#pragma once

#include "runtime/names/net.hpp"
#include "runtime/program/program.hpp"

namespace lineshaft {

/// Gives every name of the program's tasks, inputs, blocks, wires and outputs its number, and
/// checks types, units, limits and the order of scanning. What is wrong goes to `out`; the net is
/// then of what could be understood. `catalog` outlives it. `kinds` are those that the program
/// brings along; null where they could not be understood, which is reported.
Net resolve(const Program& program, const Catalog& catalog, std::shared_ptr<const Catalog> kinds,
            Diagnostics& out);

/// `NOT previous(a.b)` taken apart.
struct WireText {
    std::string signal;
    bool negated = false;
    bool previous = false;
};

/// Empty for a constant. In `{...}` a name with an index stands in quotes.
std::optional<WireText> parse_wire(const Node& node);

/// `ratio: inputs.wanted` of a block: a field and what the program gives it.
struct Assignment {
    int instance = 0;
    const Field* field = nullptr;
    const Node* value = nullptr;
    std::optional<WireText> wire = {};  ///< empty: a constant
};

/// A net while it is made: each step takes what the ones before it have found.
struct Resolving {
    const Program& program;
    const Catalog& catalog;
    Reader read;
    Net net = {};
    std::vector<Assignment> assignments = {};

    Instance& instance(const Assignment& a) {
        return net.instances[static_cast<std::size_t>(a.instance)];
    }
};

void resolve_tasks(Resolving& to);        ///< resolve_tasks.cpp
void resolve_instances(Resolving& to);    ///< resolve_instances.cpp: types and tasks
void resolve_assignments(Resolving& to);  ///< likewise
void resolve_io(Resolving& to);           ///< resolve_io.cpp
void resolve_constants(Resolving& to);    ///< resolve_constants.cpp
void resolve_wires(Resolving& to);        ///< resolve_wires.cpp

}  // namespace lineshaft
