#include "tests/fuzz/kept_runs.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "blocks/catalog.hpp"
#include "runtime/restart/checkpoint.hpp"
#include "runtime/restart/retain.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/source/text_hash.hpp"
#include "tests/source_folder.hpp"

namespace lineshaft::test {

namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t goes_on = 20 * ms;
const std::string source_folder = in_source("");

std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

void write(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// A text as if it stood in the file, so that it finds its sources.
Loaded load(const std::string& path, const std::string& text) {
    Diagnostics out;
    const auto file = std::make_shared<const SourceFile>(SourceFile{path, text});
    Loaded loaded{.program = read_program(file, {}, out), .linked = {}};
    loaded.linked = link(loaded.program, standard_blocks(), out);
    if (out.empty()) return loaded;
    std::fprintf(stderr, "%s", out.render().c_str());
    std::abort();
}

std::string retain_all(const Machine& machine) {
    std::string list;
    for (const BlockPlace& block : machine.blocks)
        if (!block.type->is_device() && !block.type->single)
            list += (list.empty() ? "" : ", ") + block.name;
    return "retain: [" + list + "]\n";
}

}  // namespace

KeptRun::KeptRun(const std::string& program, std::int64_t time, std::string folder, bool retains)
    : program_(source_folder + program),
      folder_(std::move(folder)),
      text_(read(program_)),
      time_(time) {
    if (retains) text_ += retain_all(load(program_, text_).linked.machine);
    Loaded loaded = load(program_, text_);
    RunOptions options;
    options.flush = false;
    options.checkpoint_every = time;
    options.checkpoint_path = folder_ + "/first.checkpoint";
    if (retains) options.retain_path = folder_ + "/first.ret";
    loaded.linked.machine.end = time + ms;
    for (const std::string& path : {options.checkpoint_path, options.retain_path})
        std::remove(path.c_str());
    run(loaded, options);
    const std::string bytes = read(options.checkpoint_path);
    if (!bytes.empty()) state_ = bytes.substr(bytes.find('\n') + 1);
    if (retains) retained_ = read(options.retain_path);
}

bool KeptRun::resume(const std::string& state) const {
    Loaded loaded = load(program_, text_);
    const std::string path = folder_ + "/run.checkpoint";
    write(path,
          checkpoint_of({fingerprint(loaded.program, loaded.linked.machine), "run"}, time_, state));
    loaded.linked.machine.end = time_ + goes_on;
    RunOptions options;
    options.flush = false;
    options.restart = Restart::hot;
    options.checkpoint_path = path;
    return run(loaded, options).refused.empty();
}

bool KeptRun::begin(const std::string& retained, bool mends) const {
    Loaded loaded = load(program_, text_);
    const std::string path = folder_ + "/run.ret";
    std::remove((path + ".bak").c_str());
    write(path, mends ? with_check(retained) : retained);
    loaded.linked.machine.end = goes_on;
    RunOptions options;
    options.flush = false;
    options.retain_path = path;
    return run(loaded, options).refused.empty();
}

std::vector<std::string> all_cases() {
    std::vector<std::string> cases;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder + "tests/cases"))
        if (std::filesystem::exists(entry.path() / "program.yaml"))
            cases.push_back("tests/cases/" + entry.path().filename().string() + "/program.yaml");
    std::ranges::sort(cases);
    return cases;
}

std::int64_t duration_of(const std::string& program) {
    const std::string path = source_folder + program;
    return load(path, read(path)).linked.machine.duration;
}

std::string with_check(std::string text) {
    constexpr std::string_view begin = "\"check\": \"";
    constexpr std::size_t digits = 16;
    const std::size_t at = text.find(begin);
    if (at == std::string::npos || at + begin.size() + digits > text.size()) return text;
    text.replace(at + begin.size(), digits, digits, '0');
    return text.replace(at + begin.size(), digits, text_hash(text));
}

std::vector<std::unique_ptr<KeptRun>> kept_runs(const std::string& folder, bool retains) {
    struct Begun {
        const char* program;
        std::int64_t time;
    };
    static constexpr Begun list[] = {
        {"programs/03_ratio_change.yaml", 1500 * ms},
        {"programs/05_pulses.yaml", 200 * ms},
        {"programs/06_machine_logic.yaml", 2000 * ms},
        {"programs/07_cross_coupling.yaml", 500 * ms},
        {"programs/08_state_machine.yaml", 1000 * ms},
        {"programs/10_flying_shear.yaml", 1500 * ms},
        {"programs/11_rotary_knife.yaml", 1500 * ms},
        {"programs/12_two_axes_together.yaml", 500 * ms},
        {"programs/14_contour.yaml", 700 * ms},
        {"tests/cases/axis_takes_commands/program.yaml", 300 * ms},
        {"tests/cases/phasing_waits_for_the_one_before/program.yaml", 500 * ms},
        {"tests/cases/preemption_publishes_late/program.yaml", 3 * ms},
        {"tests/cases/force_wins_and_ends/program.yaml", 100 * ms},
    };
    std::vector<std::unique_ptr<KeptRun>> runs;
    for (const Begun& begun : list)
        runs.push_back(std::make_unique<KeptRun>(begun.program, begun.time, folder, retains));
    return runs;
}

std::string damaged(std::string bytes, std::span<const std::uint8_t> choices) {
    constexpr std::size_t step = 6;
    static constexpr std::int64_t edges[] = {0,
                                             1,
                                             -1,
                                             2,
                                             3,
                                             255,
                                             1 << 20,
                                             std::numeric_limits<std::int32_t>::max(),
                                             std::numeric_limits<std::int64_t>::max(),
                                             std::numeric_limits<std::int64_t>::min(),
                                             0x7FF0000000000000,
                                             0x7FF8000000000000,
                                             0x43E0000000000000,
                                             -(std::int64_t{1} << 61),
                                             std::int64_t{1} << 61,
                                             8};
    for (; choices.size() >= step && !bytes.empty(); choices = choices.subspan(step)) {
        const std::size_t at =
            (choices[1] + 256U * choices[2] + 65536U * choices[3]) % bytes.size();
        const std::size_t word = at / 8 * 8;
        char* const place = bytes.data() + at;
        const bool has_word = word + 8 <= bytes.size();
        switch (choices[0] % 7) {
            case 0:
                *place = static_cast<char>(*place ^ 1 << choices[4] % 8);
                break;
            case 1:
                *place = static_cast<char>(choices[4]);
                break;
            case 2:
                if (has_word)
                    std::memcpy(bytes.data() + word, &edges[choices[4] % std::size(edges)], 8);
                break;
            case 3:
                if (has_word)
                    std::memcpy(bytes.data() + word,
                                bytes.data() + choices[4] * 256U % (bytes.size() - 7), 8);
                break;
            case 4:
                if (has_word) {
                    std::int64_t value = 0;
                    std::memcpy(&value, bytes.data() + word, 8);
                    value = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) +
                                                      choices[4] - 128U);
                    std::memcpy(bytes.data() + word, &value, 8);
                }
                break;
            case 5:
                bytes.erase(at, 1U + choices[4] % 16);
                break;
            default:
                bytes.insert(at, 1U + choices[4] % 16, static_cast<char>(choices[5]));
        }
    }
    return bytes;
}

}  // namespace lineshaft::test
