#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "runtime/model/address.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/names/signal.hpp"
#include "runtime/names/task_settings.hpp"
#include "runtime/source/reader.hpp"

namespace lineshaft {

/// When a wire takes its source's value.
enum class Late : std::uint8_t {
    now,        ///< of this scan: the source stands before in the same task
    previous,   ///< of the last scan: the source is later in the same task, or the block itself
    delayed,    ///< of the last scan, of a source earlier in the task: taken as the scan begins
    published,  ///< as other tasks see it, or from outside
};

/// What feeds an input. Source and target are of one type after `widens`, and of one unit after
/// `factor` over `divisor`.
struct Wire {
    Port from, to;
    Late late = Late::published;
    bool negated = false;
    std::optional<Type> widens = {};  ///< an integer of that type to a real
    bool scaled = false;
    double factor = 1, divisor = 1;
};

/// `axis: shaft`: a block that acts on another one.
struct Reference {
    Port from;
    int to = -1;  ///< the other's number, which stands in the field, too
};

/// Which of two blocks of a task is scanned first.
struct Order {
    int before = 0, after = 0;
    bool together = false;  ///< both may stand in one call: all its inputs are copied first
};

/// A block of the program, with the number that it has in the file.
struct Instance {
    std::string name;
    const BlockType* type = nullptr;    ///< null: unknown, already reported
    int task = -1;                      ///< -1: unknown, already reported
    std::int64_t cost = 0;              ///< its own share of its task's [ns]
    std::vector<std::byte> image = {};  ///< as it begins: constants are in place
    std::vector<bool> wired = {};       ///< by field
    bool is_only_named = false;         ///< a PROGRAM that no task scans, and sources name

    bool known() const { return type && task >= 0; }
    std::string described() const;  ///< `'drive' (servo_drive)`
};

struct InputNode {
    std::string name;
    std::optional<Signal> signal = {};  ///< empty: reported
    Value initial = {};
    /// Its type, and the narrowest limits of what it feeds in blocks of sources, which are stopped
    /// by a value that they cannot hold.
    Field field = {};
};

struct OutputNode {
    std::string name;
    std::optional<Signal> shows = {};  ///< empty: reported
};

/// A program with its names resolved: everything by number. What a name means is asked here.
struct Net {
    std::vector<TaskSettings> tasks;  ///< by priority, then by place in the file
    int main_task = -1;       ///< the cyclic one of lowest priority: its start begins a cycle
    bool tasks_known = true;  ///< false: a name may be one of those that were not read
    std::vector<InputNode> inputs;
    std::vector<OutputNode> outputs;
    std::vector<Instance> instances;
    std::vector<Wire> wires;  ///< block by block, each in the order of the file
    std::vector<Reference> references;
    std::vector<Order> orders;
    std::unordered_map<std::string, int> instance_numbers;
    const Catalog* catalog = nullptr;
    std::shared_ptr<const Catalog> kinds;  ///< that the program brings along; may be null

    const Instance& instance(int number) const {
        return instances[static_cast<std::size_t>(number)];
    }
    const Instance& instance(Port port) const { return instance(port.instance); }
    const Field& field(Port port) const {
        return instance(port).type->fields[static_cast<std::size_t>(port.field)];
    }

    /// The signal of that name, not yet laid out. L0204, L0203 or L0208 at `node` for one that is
    /// not there; nothing is said again of what could not be read.
    std::optional<Signal> find(const Reader& read, const Node& node, std::string_view name) const;

    /// As the sources write addresses, and so the program's file.
    AddressCount count_of_addresses() const;

    /// The block of that name. -1, and L0204 at `node`, when there is none; nothing is said where
    /// it may be a data block of sources with a mistake.
    int find_block(const Reader& read, const Node& node, std::string_view name) const;

    /// A port's name to look for similar ones of; empty where it is a name in some kind of block,
    /// so written as it is meant: then there is nothing to guess.
    std::string_view misspelt(std::string_view port) const;

    /// -1, and L0206, when there is no such task; -1 alone for an empty name.
    int find_task(const Reader& read, const Node& node, std::string_view name) const;

    /// Those that feed the instance, in the order of the file.
    std::span<const Wire> wires_to(int instance) const;

    /// Where a field of the instance is.
    Port port(int instance, const Field& field) const;
    Signal signal(Port port) const;

    /// `{unit}/s` with the instance's own parameter `unit` put in, `{Axis}/s` with that of the
    /// block which its reference `Axis` names.
    const Unit& unit_of(Port port) const;
    /// The unit of a text as the block's fields have it.
    const Unit& unit_of(const Instance& block, std::string_view text) const;
    /// The unit that a text is.
    const Unit& unit(const std::string& text) const;

  private:
    std::string chosen_unit(const Instance& block, const Field& chosen) const;
    std::optional<Signal> find_input(const Reader& read, const Node& node,
                                     std::string_view name) const;
    std::optional<Signal> find_address(const Reader& read, const Node& node,
                                       std::string_view text) const;
    std::optional<Signal> find_output(const Reader& read, const Node& node,
                                      std::string_view name) const;
    void unknown_port(const Reader& read, const Node& node, const Instance& block,
                      std::string_view port) const;

    mutable std::unordered_map<std::string, Unit> units_;  ///< parsed once
};

/// `real`, or an enumeration's names.
std::string kind(Type type, const ValueNames& names);

}  // namespace lineshaft
