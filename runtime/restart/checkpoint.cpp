#include "runtime/restart/checkpoint.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/program/meaning.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/json_text.hpp"
#include "runtime/source/text_hash.hpp"
#include "runtime/trace/output_file.hpp"
#include "runtime/version.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t checkpoint_layout = 8;  // of the state
constexpr std::size_t longest_head = 1 << 16;  // bytes

/// What is wrong with a checkpoint; empty when nothing is.
std::string refusal(const Json& head, const std::string& state, const RunBy& by) {
    const auto of = integer_at(head, "lineshaft_checkpoint", 1, checkpoint_layout);
    if (!of) return "this is not a checkpoint";
    if (*of < checkpoint_layout)
        return "the checkpoint is of an earlier lineshaft, whose blocks were laid out otherwise";
    if (text_at(head, "version") != version())
        return fmt::format("the checkpoint is of lineshaft {}, this is {}",
                           text_at(head, "version"), version());
    if (text_at(head, "command") != by.command)
        return fmt::format(
            "the checkpoint is of '{}': a served machine has no end, and a run judges what is "
            "expected from its start",
            text_at(head, "command"));
    if (text_at(head, "program") != by.program)
        return "the checkpoint is of another program, or of other parameters";
    if (text_at(head, "state") != text_hash(state)) return "the checkpoint is not whole";
    return {};
}

std::string_view bytes_of(const std::vector<Replay::Point>& points) {
    return {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Replay::Point)};
}

}  // namespace

std::string fingerprint(const Program& program, const Machine& machine) {
    std::string text = meaning_of(program).in_force;
    for (const auto& [name, value] : program.parameters) text += fmt::format("{}={};", name, value);
    text += fmt::format("{} {} {} {};", machine.memory.size(), machine.seed, machine.duration,
                        machine.main_task);
    for (const Task& task : machine.tasks)
        text += fmt::format("{} {} {} {} {} {} {} {} {} {};", task.name, task.every, task.offset,
                            task.priority, task.jitter, task.cost, task.cost_jitter, task.size,
                            task.maximum_cycle_time, task.on_overrun);
    for (const Signal& signal : machine.signals)
        text += fmt::format("{} {} {} {};", signal.name, name_of(signal.type), signal.unit,
                            signal.slot - machine.memory.data());
    for (const Force& force : machine.forces)
        text += fmt::format("{} {} {};", force.text(), force.from, force.until);
    for (const Replay& replay : machine.replays)
        text += fmt::format("{};", text_hash(bytes_of(replay.points())));
    return text_hash(text);
}

std::string checkpoint_of(const RunBy& by, std::int64_t time, const std::string& state) {
    const Json head{{"lineshaft_checkpoint", checkpoint_layout},
                    {"version", version()},
                    {"program", by.program},
                    {"command", by.command},
                    {"time_ns", time},
                    {"state", text_hash(state)}};
    return head.dump() + "\n" + state;
}

std::string write_checkpoint(const std::string& path, const std::string& checkpoint) {
    OutputFile file(path);
    file.write(checkpoint);
    file.commit();
    return file.error();
}

std::optional<std::string> read_checkpoint(const std::string& path, const RunBy& by,
                                           Diagnostics& out) {
    int error = 0;
    std::string bytes = read_bytes(path, std::numeric_limits<std::size_t>::max(), error);
    if (error != 0) {
        out.add(code::file_cannot_be_read, {}, fmt::format("cannot read the checkpoint '{}'", path),
                "--checkpoint-every writes one, --checkpoint names it");
        return {};
    }
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const Json head = parse_json(std::string_view(bytes).substr(0, std::min(end, longest_head)));
    std::string state = std::move(bytes);
    state.erase(0, std::min(end + 1, state.size()));
    const std::string wrong = refusal(head, state, by);
    if (wrong.empty()) return state;
    out.add(code::checkpoint_does_not_fit,
            {std::make_shared<SourceFile>(SourceFile{path, {}}), 0, 0, 1}, wrong,
            "'serve' goes on from what it wrote, 'run' from what that wrote; without --resume it "
            "runs from its start");
    return {};
}

}  // namespace lineshaft
