#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "runtime/csv/csv_reader.hpp"
#include "runtime/trace/checksum.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct VerifyCommand {
    std::vector<std::string> files;
    bool json = false, quiet = false;
};

/// Empty, and an L0001 diagnostic, when it cannot be read.
std::optional<std::string> checksum_of(const std::string& path, Diagnostics& out) {
    Checksum checksum;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               &std::fclose);
    std::array<char, 1 << 16> part;
    for (std::size_t count = part.size(); file && count == part.size();) {
        count = std::fread(part.data(), 1, part.size(), file.get());
        checksum.add({part.data(), count});
    }
    if (file && !std::ferror(file.get())) return checksum.text();
    out.add("L0001", {}, fmt::format("cannot read '{}': {}", path, std::strerror(errno)));
    return {};
}

bool is_mistake_of_file(const Diagnostic& d) {
    return d.code != "L0001" && d.code != "L0707" && d.code != "L0709";
}

/// What is wrong with the trace goes to `out`: L0709 when there is no sidecar to go by.
std::optional<CsvTable> verify(const std::string& path, Diagnostics& out) {
    auto table = read_csv(path, out);
    if (!table) return {};
    if (!table->metadata || table->metadata->crc32.empty())
        out.add("L0709", {table->header, 0, 0, 1}, "no sidecar tells what the trace was",
                fmt::format("a trace is whole if it is as '{}' says", sidecar_path(path)));
    else if (const auto is = checksum_of(path, out); is && *is != table->metadata->crc32)
        out.add(
            "L0706", {table->header, 0, 0, 1},
            fmt::format("the CRC-32 of its bytes is {}, and was {}", *is, table->metadata->crc32),
            "the file was changed after it had been recorded");
    return table;
}

Exit execute(const VerifyCommand& command) {
    Diagnostics out;
    for (const std::string& path : command.files) {
        const std::size_t before = out.list().size();
        const auto table = verify(path, out);
        if (out.list().size() != before || command.json || command.quiet) continue;
        fmt::print("ok  {}: {} rows of {} columns, written by lineshaft {} for '{}'\n", path,
                   table->rows, table->columns.size(), table->metadata->version,
                   table->metadata->title);
        if (const std::string& stopped = table->metadata->stopped; !stopped.empty())
            fmt::print("    the run did not complete: {}\n", stopped);
    }
    if (out.empty() && command.json) fmt::print("{{\"diagnostics\": []}}\n");
    if (out.empty()) return Exit::fine;
    report(out, command.json);
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
