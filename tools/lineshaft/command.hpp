#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/model/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/st/library/library.hpp"

namespace lineshaft {

/// What a command ends with.
enum class Exit : int {
    fine = 0,
    failed = 1,  ///< an expectation, a bound or a claim does not hold
    wrong = 2,   ///< the program or the command line is wrong
    fault = 3,   ///< something went wrong while running: a block's error, a full disk
    interrupted = 130,
    unread = 141,  ///< nobody reads the standard output any more
};

/// Whether the standard output is a pipe whose reader has ended, as `head` does.
bool is_unread();

/// Since the command began, what it read included [s].
double wall_seconds();

/// What most commands share.
struct CommonOptions {
    std::vector<std::string> settings;  ///< `name=value`
    std::vector<std::string> include_dirs;
    bool json = false;
    bool quiet = false;

    void add_to(CLI::App& command);
    /// L0502 for what is not `name=value`.
    LoadOptions load_options(Diagnostics& out) const;
};

/// Prints what is wrong, else what is warned of, as a compiler does on stderr, or as JSON on
/// stdout. Exit::wrong, or Exit::interrupted when reading was.
Exit report(const Diagnostics& diagnostics, bool json);

/// One of a few words, for Option::transform.
template <class Value>
CLI::Validator one_of(const std::map<std::string, Value>& values) {
    return CLI::Validator(
        [values](std::string& word) {
            const auto it = values.find(word);
            std::vector<std::string> words;
            for (const auto& [each, value] : values) words.push_back(each);
            if (it == values.end())
                return fmt::format("'{}' is none of {}", word, fmt::join(words, ", "));
            word = std::to_string(static_cast<int>(it->second));
            return std::string();
        },
        "");
}

/// `--strict`: warnings are errors.
void add_strict(CLI::App& command, bool& strict);

/// `--no-native`: Structured Text is interpreted; `--native`: it is compiled.
void add_native(CLI::App& command);

/// `--source-dialect`: how files in `.st` are read that no program names.
void add_dialect(CLI::App& command);

/// L0509 for each of `outputs` that is, by whatever name, a file which has been read so far or one
/// of `inputs`, which are still to be read, or that is named twice; L0502 for a folder of theirs
/// that is not there. Empty names are none.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   Diagnostics& out);

/// A line on a terminal that is rewritten while work goes on, once a second has passed.
class ProgressLine {
  public:
    explicit ProgressLine(bool quiet);
    ~ProgressLine();
    void show(const std::function<std::string(double elapsed_seconds)>& text);
    void clear();  ///< before a line of another kind

  private:
    bool enabled_;
    std::int64_t start_, shown_ = 0;
};

/// That a file or a folder has no source, and which files of other tools stand in it.
void tell_no_source(const std::string& path, Diagnostics& out);

/// The texts of sources in any form, and of all in folders.
std::vector<std::shared_ptr<const SourceFile>> read_files(
    const std::vector<std::string>& files, const std::vector<std::string>& include_dirs,
    Diagnostics& out);

/// An option of signals: `--signals a.x,b.y`, which are put into `names`; that many, where it is
/// said.
CLI::Option* add_signals(CLI::App& command, const std::string& option,
                         std::vector<std::string>& names, const std::string& doc,
                         std::size_t count = 0);

/// What `lineshaft report` does, of these signals.
Exit write_report(std::vector<std::string> inputs, std::vector<std::string> signals,
                  const std::string& output, bool quiet);

/// The same of what study_json() made, and of the traces that it names.
Exit report_study(const nlohmann::ordered_json& study, const std::string& output, bool quiet);

/// `name` of the subcommand on `app`; `result` gets its exit code.
using AddCommand = void (*)(CLI::App& app, Exit& result);
void add_new(CLI::App& app, Exit& result);
void add_run(CLI::App& app, Exit& result);
void add_serve(CLI::App& app, Exit& result);
void add_debug(CLI::App& app, Exit& result);
void add_check(CLI::App& app, Exit& result);
void add_test(CLI::App& app, Exit& result);
void add_study(CLI::App& app, Exit& result);
void add_blocks(CLI::App& app, Exit& result);
void add_units(CLI::App& app, Exit& result);
void add_states(CLI::App& app, Exit& result);
void add_schema(CLI::App& app, Exit& result);
void add_form(CLI::App& app, Exit& result);
void add_explain(CLI::App& app, Exit& result);
void add_plan(CLI::App& app, Exit& result);
void add_fit(CLI::App& app, Exit& result);
void add_diff(CLI::App& app, Exit& result);
void add_verify(CLI::App& app, Exit& result);
void add_contour(CLI::App& app, Exit& result);
void add_report(CLI::App& app, Exit& result);
void add_show(CLI::App& app, Exit& result);
void add_plot(CLI::App& app, Exit& result);
void add_format(CLI::App& app, Exit& result);
void add_lsp(CLI::App& app, Exit& result);

}  // namespace lineshaft
