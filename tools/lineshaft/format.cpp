#include <filesystem>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "runtime/projects/project.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/entries.hpp"
#include "runtime/st/syntax/style.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

struct FormatCommand {
    std::vector<std::string> files;
    bool check = false;
};

std::vector<std::string> sources_in(const std::string& path) {
    std::error_code unknown;
    if (!fs::is_directory(path, unknown)) return {path};
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(path))
        if (is_file_to_read(entry) && is_structured_text(entry.path()))
            files.push_back(entry.path().lexically_normal().string());
    std::ranges::sort(files);
    return files;
}

/// A link stays one, and what it leads to keeps its permissions.
bool write_file(const std::string& path, const std::string& text) {
    std::error_code unknown;
    const fs::path target =
        fs::is_symlink(path, unknown) ? fs::canonical(path, unknown) : fs::path(path);
    OutputFile file(target.string());
    file.write(text);
    if (file.error().empty())
        fs::permissions(file.part(), fs::status(target, unknown).permissions(), unknown);
    if (file.commit()) return true;
    spdlog::error("{}", file.error());
    file.discard();
    return false;
}

Exit format(const std::string& path, bool check) {
    Diagnostics out;
    const auto file = read_source(path, out);
    if (!file) return report(out, false);
    int error = 0;
    if (read_bytes(path, file->text.size() + 1, error) != file->text) {
        spdlog::error("{} is left as it is: it is not in UTF-8", path);
        return Exit::wrong;
    }
    const auto styled = is_structured_text(path) ? st::in_style(file, out) : std::nullopt;
    if (!out.empty()) report(out, false);
    if (!styled) {
        spdlog::error("{} is left as it is: {}", path,
                      out.empty() ? "it is no Structured Text" : "see above");
        return Exit::wrong;
    }
    if (*styled == file->text) return Exit::fine;
    if (check) fmt::print("{} is not in the style\n", path);
    if (check) return Exit::failed;
    if (!write_file(path, *styled)) return Exit::fault;
    fmt::print("{}\n", path);
    return Exit::fine;
}

}  // namespace

void add_format(CLI::App& app, Exit& result) {
    auto command = std::make_shared<FormatCommand>();
    CLI::App* sub =
        app.add_subcommand("format", "Write files of Structured Text anew, in the one style");
    sub->add_option("files", command->files, "Files, and folders of them")->required();
    sub->add_flag("--check", command->check, "Only say which are not in the style; exit code 1");
    sub->callback([command, &result] {
        for (const std::string& path : command->files) {
            const std::vector<std::string> found = sources_in(path);
            if (found.empty()) spdlog::error("'{}' has no Structured Text", path);
            if (found.empty()) result = std::max(result, Exit::wrong);
            for (const std::string& file : found)
                result = std::max(result, format(file, command->check));
        }
    });
}

}  // namespace lineshaft
