#include <algorithm>

#include <fmt/format.h>

#include "runtime/csv/csv_reader.hpp"
#include "runtime/source/codes.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct VerifyCommand {
    std::vector<std::string> files;
    bool json = false, quiet = false;
};

bool is_mistake_of_file(const Diagnostic& d) {
    return d.code != code::file_cannot_be_read && d.code != code::sidecar_not_understood &&
           d.code != code::no_sidecar;
}

/// What is wrong with the trace goes to `out`: L0709 when there is no sidecar to go by.
std::optional<CsvTable> verify(const std::string& path, Diagnostics& out) {
    auto table = read_csv(path, out);
    if (!table) return {};
    const auto fail = [&](const char* code, const std::string& message, const std::string& help) {
        out.add(code, {table->header, 0, 0, 1}, message, help);
    };
    const auto& told = table->metadata;
    if (!told || told->crc32.empty())
        fail(code::no_sidecar, "no sidecar tells what the trace was",
             fmt::format("a trace is whole if it is as '{}' says", sidecar_path(path)));
    else if (!told->intact)
        fail(code::no_sidecar, "the sidecar has no checksum of itself",
             "record the trace again with this version of lineshaft");
    else if (!*told->intact)
        fail(code::csv_is_not_whole, "its sidecar is not as it was recorded",
             "the sidecar was changed: its units, types or hashes may be wrong");
    else if (table->crc32 != told->crc32)
        fail(code::csv_is_not_whole,
             fmt::format("the CRC-32 of its bytes is {}, and was {}", table->crc32, told->crc32),
             "the file was changed after it had been recorded");
    return table;
}

Exit execute(const VerifyCommand& command) {
    Diagnostics out;
    for (const std::string& path : command.files) {
        const std::size_t before = out.count();
        const auto table = verify(path, out);
        if (out.count() != before || command.json || command.quiet) continue;
        fmt::print("ok  {}: {} rows of {} columns, written by lineshaft {} for '{}'\n", path,
                   table->rows, table->columns.size(), table->metadata->version,
                   table->metadata->title);
        if (const std::string& stopped = table->metadata->stopped; !stopped.empty())
            fmt::print("    the run did not complete: {}\n", stopped);
    }
    if (out.empty() && command.json) fmt::print("{{\"diagnostics\": []}}\n");
    if (out.empty()) return Exit::fine;
    if (report(out, command.json) == Exit::interrupted) return Exit::interrupted;
    const bool unknown = !std::ranges::all_of(out.list(), is_mistake_of_file);
    return unknown ? Exit::wrong : Exit::failed;
}

}  // namespace

void add_verify(CLI::App& app, Exit& result) {
    auto command = std::make_shared<VerifyCommand>();
    CLI::App* sub =
        app.add_subcommand("verify", "Say whether traces are whole; exit code 1 if one is not");
    sub->add_option("files", command->files, "Traces, CSV files with their sidecars")->required();
    sub->add_flag("--json", command->json, "Print one JSON object for machines");
    sub->add_flag("--quiet", command->quiet, "Say nothing of those that are whole");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
