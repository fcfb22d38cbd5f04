#include "tools/lineshaft/command.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include "blocks/catalog.hpp"
#include "runtime/names/signal_list.hpp"
#include "runtime/projects/foreign_files.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/code/native/compile.hpp"
#include "runtime/st/syntax/dialect.hpp"

namespace lineshaft {

namespace {

const auto begun = std::chrono::steady_clock::now();

std::int64_t now_ms() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

nlohmann::ordered_json to_json(const Diagnostic& d) {
    return {{"severity", d.is_warning ? "warning" : "error"},
            {"code", d.code},
            {"file", d.mark.file ? d.mark.file->path : ""},
            {"line", d.mark.line},
            {"column", d.mark.column},
            {"message", d.whole_message()},
            {"help", d.help}};
}

bool is_same_file(const std::string& a, const std::string& b) {
    std::error_code unknown;  // what cannot be looked at is not there
    return std::filesystem::is_regular_file(a, unknown) &&
           std::filesystem::equivalent(a, b, unknown);
}

}  // namespace

bool is_unread() {
    pollfd output{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
    return ::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

void CommonOptions::add_to(CLI::App& command) {
    command.add_option("--set", settings, "Set a parameter of the program: name=value")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->expected(1, -1)
        ->trigger_on_parse(false);
    command.add_option("--include-dir", include_dirs, "Allow files below this folder, too")
        ->type_name("DIR");
    command.add_flag("--json", json, "Print one JSON object for machines");
    add_native(command);
    command.add_flag("--quiet", quiet, "Print results only, and nothing where a file takes them");
}

LoadOptions CommonOptions::load_options(Diagnostics& out) const {
    LoadOptions options{.settings = {}, .include_dirs = include_dirs};
    for (const std::string& text : settings) {
        const auto equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            out.add(code::unusable_option, {}, fmt::format("'{}' sets nothing", text),
                    "write --set name=value");
            continue;
        }
        options.settings.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    return options;
}

void add_strict(CLI::App& command, bool& strict) {
    command.add_flag("--strict", strict, "Take warnings for errors");
}

void add_dialect(CLI::App& command) {
    std::map<std::string, std::string_view> endings;
    for (const st::DialectName& dialect : st::dialect_names())
        endings.emplace(dialect.name, dialect.ending);
    const auto take = [endings](const std::string& name) {
        st::read_plain_text_as(endings.at(name));
    };
    command
        .add_option_function<std::string>(
            "--source-dialect", take,
            "How files in .st are read, as programs say in 'dialect:'; else as the standard says")
        ->check(CLI::IsMember(endings))
        ->type_name("NAME");
}

void add_native(CLI::App& command) {
    const auto compile = [] {
        st::compile_natively([](const std::string& why) {
            fmt::print(stderr,
                       "lineshaft: warning: --native: {}; code is copied and patched instead, "
                       "which is slower\n",
                       why);
        });
    };
    CLI::Option* const off =
        command.add_flag_callback("--no-native", st::switch_native_off,
                                  "Interpret Structured Text: slower, and the same in all else");
    command
        .add_flag_callback("--native", compile,
                           "Have Structured Text compiled by the system's C++ compiler, once: "
                           "faster, and the same in all else")
        ->excludes(off);
}

std::vector<std::shared_ptr<const SourceFile>> read_files(
    const std::vector<std::string>& files, const std::vector<std::string>& include_dirs,
    Diagnostics& out) {
    projects::Project all;
    for (const std::string& file : files) {
        const projects::Project read = read_project(file, include_dirs, out);
        for (const auto& source : read.sources) all.add(source);
        if (read.sources.empty() && out.empty()) tell_no_source(file, out);
    }
    return all.sources;
}

void tell_no_source(const std::string& path, Diagnostics& out) {
    const std::string left = projects::foreign_files_below(path);
    out.add(code::file_cannot_be_read, {},
            fmt::format("there is no source of a controller in '{}'{}{}", path,
                        left.empty() ? "" : ", but ", left),
            left.empty()
                ? "name Structured Text, or a project of another tool: lineshaft check --help"
                : "'lineshaft check' of one of them says what to do with it");
}

Exit report(const Diagnostics& diagnostics, bool json) {
    const Exit exit = interrupt_requested ? Exit::interrupted : Exit::wrong;
    if (!json) {
        fmt::print(stderr, "{}", diagnostics.render());
        return exit;
    }
    auto list = nlohmann::ordered_json::array();
    for (const Diagnostic& d : diagnostics.empty() ? diagnostics.warnings() : diagnostics.list())
        list.push_back(to_json(d));
    const nlohmann::ordered_json all{{"diagnostics", list}};
    fmt::print("{}\n", all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return exit;
}

/// The folder that a file would be in and that is not there; empty: it is there.
static std::string missing_folder(const std::string& file) {
    std::error_code unknown;  // opening tells it
    const auto folder = std::filesystem::path(file).parent_path();
    const bool is_missing = !folder.empty() && std::filesystem::status(folder, unknown).type() ==
                                                   std::filesystem::file_type::not_found;
    return is_missing ? folder.string() : "";
}

void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   Diagnostics& out) {
    std::set<std::string> missing;
    for (auto output = outputs.begin(); output != outputs.end(); ++output) {
        if (output->empty()) continue;
        if (was_read(*output) || std::ranges::any_of(inputs, [&](const std::string& input) {
                return is_same_file(*output, input);
            }))
            out.add(code::output_is_an_input, {},
                    fmt::format("'{}' would replace what is read", *output), "name another file");
        if (std::find(outputs.begin(), output, *output) != output)
            out.add(code::output_is_an_input, {}, fmt::format("two outputs would be '{}'", *output),
                    "name another file");
        const std::string folder = missing_folder(*output);
        if (!folder.empty()) missing.insert(folder);
    }
    for (const std::string& folder : missing) {
        std::error_code failed;
        if (out.empty()) std::filesystem::create_directories(folder, failed);
        if (failed)
            out.add(code::unusable_option, {},
                    fmt::format("cannot make the folder '{}': {}", folder, failed.message()),
                    "name another one");
    }
}

CLI::Option* add_signals(CLI::App& command, const std::string& option,
                         std::vector<std::string>& names, const std::string& doc,
                         std::size_t count) {
    const auto take = [&names, option, count](const std::vector<std::string>& lists) {
        for (const std::string& list : lists)
            for (std::string& name : signals_in(list)) names.push_back(std::move(name));
        if (count == 0 || names.size() == count) return;
        const int wanted = static_cast<int>(count);
        throw names.size() < count ? CLI::ArgumentMismatch::AtLeast(option, wanted, names.size())
                                   : CLI::ArgumentMismatch::AtMost(option, wanted, names.size());
    };
    const int most = count == 0 ? CLI::detail::expected_max_vector_size : static_cast<int>(count);
    return command.add_option_function<std::vector<std::string>>(option, take, doc)
        ->expected(1, most);
}

ProgressLine::ProgressLine(bool quiet)
    : enabled_(!quiet && ::isatty(STDERR_FILENO) == 1), start_(now_ms()) {}

ProgressLine::~ProgressLine() {
    clear();
}

void ProgressLine::clear() {
    if (shown_ > 0) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::show(const std::function<std::string(double)>& text) {
    constexpr std::int64_t first_ms = 1000, every_ms = 200;
    if (!enabled_) return;
    const std::int64_t elapsed = now_ms() - start_;
    if (elapsed < first_ms || elapsed - shown_ < every_ms) return;
    shown_ = elapsed;
    fmt::print(stderr, "\r\033[K{}", text(static_cast<double>(elapsed) / 1e3));
    std::fflush(stderr);
}

}  // namespace lineshaft
