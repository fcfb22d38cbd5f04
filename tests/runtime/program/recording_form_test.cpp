#include "runtime/program/recording_form.hpp"

#include <fstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr int entries = 6000;  // some pieces of what is read at once

std::string recording(const std::string& comment, int wrong = -1) {
    std::string text = "lineshaft_recording: 1\nprogram: 'p.yaml'\nentries:\n" + comment;
    for (int i = 0; i < entries; ++i)
        text += fmt::format("- {{at: {} ms, {}: {{inputs.level: {}}}}}\n", i,
                            i == wrong ? "sett" : "set", i);
    return text;
}

std::optional<RecordingPlan> read_text(const std::string& text, Diagnostics& out) {
    const Folder folder;
    std::ofstream(folder / "r.yaml", std::ios::binary) << text;
    return read_recording(folder / "r.yaml", out);
}

}  // namespace

TEST_CASE("a long recording has each of its entries, with its line, however it is laid out") {
    for (const std::string comment : {"", "# by hand\n"}) {
        Diagnostics out;
        const auto plan = read_text(recording(comment), out);
        INFO(out.render());
        REQUIRE(plan);
        REQUIRE(plan->entries.size() == entries);
        const int first_line = comment.empty() ? 4 : 5;
        for (int i = 0; i < entries; ++i) {
            const RecordedPlan& entry = plan->entries[static_cast<std::size_t>(i)];
            CHECK(entry.at == i * std::int64_t{1'000'000});
            CHECK(entry.set.at(0).second.text == std::to_string(i));
            CHECK(entry.mark.line == first_line + i);
        }
    }
}

TEST_CASE("a mistake far into a recording is told at its place") {
    Diagnostics out;
    CHECK_FALSE(read_text(recording("", 5000), out));
    REQUIRE(out.count() == 1);
    CHECK_THAT(out.render(), Catch::Contains("r.yaml:5004:17: error[L0201]") &&
                                 Catch::Contains("5004 | - {at: 5000 ms, sett: {inputs.level"));
}

TEST_CASE("an unfinished last line of a recording is no entry, and no entries are none") {
    Diagnostics out;
    const auto cut = read_text(recording("") + "- {at: 9 s, end: tr", out);
    REQUIRE(cut);
    CHECK(cut->entries.size() == entries);
    const auto none = read_text("lineshaft_recording: 1\nentries:\n", out);
    REQUIRE(none);
    CHECK(none->entries.empty());
    CHECK(out.empty());
    for (const char* const wrong : {"", "x", "entries:\n", "lineshaft_recording: 1\n"})
        CHECK_FALSE(read_text(wrong, out));
}
