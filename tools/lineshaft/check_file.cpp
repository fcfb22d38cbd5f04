#include "tools/lineshaft/check_file.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/fit/fit.hpp"
#include "runtime/program/program_form.hpp"
#include "runtime/program/recording_form.hpp"
#include "runtime/projects/foreign_files.hpp"
#include "runtime/run/link.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/study/study_reader.hpp"

namespace lineshaft {

namespace {

void check_controller(const std::shared_ptr<const SourceFile>& file, Diagnostics& out) {
    const auto root = parse_yaml(file, out);
    const Reader read(out);
    Program tasks;
    if (root && check_kind(read, *root, "lineshaft_controller"))
        read_form(controller_form(), read, *root, tasks);
}

}  // namespace

std::optional<CheckedProgram> check_file(const std::string& path, const LoadOptions& options,
                                         Diagnostics& out) {
    std::error_code unknown;
    const auto known = projects::foreign_file(path);
    if (known && std::filesystem::exists(path, unknown)) {
        out.add(code::not_supported, {},
                fmt::format("'{}' is {}, which is not read", path, known->what), known->help);
        return {};
    }
    const auto file = read_source(path, out);
    if (!file) return {};
    const Catalog& catalog = standard_blocks();
    if (is_study(*file)) {
        read_study(file, options, catalog, out);
    } else if (is_fit(*file)) {
        read_fit(file, options, catalog, out);
    } else if (file->has_key("lineshaft_controller:")) {
        check_controller(file, out);
    } else if (file->has_key("lineshaft_recording:")) {
        read_recording(path, out);
    } else {
        CheckedProgram checked{read_program(file, options, out), {}};
        checked.net = link(checked.program, catalog, out).net;
        return checked;
    }
    return {};
}

}  // namespace lineshaft
