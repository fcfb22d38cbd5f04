#include "runtime/projects/task_classes.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "runtime/projects/automation_studio.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t usual_ms[] = {10, 20, 50, 100, 200, 500, 1000, 10};

/// 4 of `Cyclic#4`; 0: it is not cyclic.
std::size_t number_of_class(std::string_view name) {
    constexpr std::string_view before = "Cyclic#";
    if (!name.starts_with(before) || name.size() != before.size() + 1) return 0;
    const auto number = static_cast<std::size_t>(name.back() - '0');
    return number <= std::size(usual_ms) ? number : 0;
}

/// `FeederArm.feeder.prg`: its folder is the program's name.
std::string name_of_program(std::string_view source) {
    source = source.substr(0, source.rfind('.'));
    return std::string(source.substr(source.rfind('.') + 1));
}

/// What `CyclicNDuration` says, in us [ns]; 0: nothing.
std::int64_t duration_of(const XmlFile& hardware, std::size_t number) {
    const std::string id = fmt::format("Cyclic{}Duration", number);
    std::int64_t us = 0;
    for (const pugi::xml_node module : hardware.root().children("Module"))
        for (const pugi::xml_node parameter : module.children("Parameter")) {
            if (hardware.plain(parameter.attribute("ID")) != id) continue;
            const std::string value = hardware.plain(parameter.attribute("Value"));
            std::from_chars(value.data(), value.data() + value.size(), us);
        }
    return us > 0 && us <= 86'400'000'000 ? us * 1000 : 0;
}

/// One warning for all programs in C, which no source stands for.
class InC {
  public:
    explicit InC(const XmlFile& file) : file_(file) {}

    bool take(pugi::xml_node program) {
        if (!file_.plain(program.attribute("Language")).starts_with("ANSI")) return false;
        if (names_.empty()) first_ = file_.mark_of_tag(program);
        names_.push_back(name_of_program(file_.plain(program.attribute("Source"))));
        return true;
    }

    void tell(Diagnostics& out) const {
        if (!names_.empty())
            out.warn(code::not_supported, first_,
                     fmt::format("written in C, and so not read and not run: {}",
                                 fmt::join(names_, ", ")),
                     "write in Structured Text what the other programs need of it");
    }

  private:
    const XmlFile& file_;
    std::vector<std::string> names_;
    Mark first_;
};

}  // namespace

bool is_software_of_cpu(const fs::path& file) {
    return lower(file.filename().string()) == "cpu.sw" && is_of_hardware(file);
}

void read_task_classes(const Reading& to, const std::string& path, const Mark& where) {
    if (!to.project.tasks.empty()) return;
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    const fs::path beside = fs::path(path).parent_path().parent_path() / "Hardware.hw";
    Diagnostics unread;
    const auto hardware = XmlFile::read(beside.string(), unread);
    InC in_c(*file);
    for (const pugi::xml_node element : file->root().children("TaskClass")) {
        const std::string name = file->plain(element.attribute("Name"));
        const std::size_t number = number_of_class(name);
        if (number == 0) continue;
        const std::int64_t said = hardware ? duration_of(*hardware, number) : 0;
        ProjectTask task{.name = {name, file->mark_of_tag(element)},
                         .every = said > 0 ? said : usual_ms[number - 1] * 1'000'000,
                         .priority = static_cast<std::int64_t>(number)};
        for (const pugi::xml_node program : element.children("Task"))
            if (file->plain(program.attribute("Disabled")) != "true" && !in_c.take(program))
                task.programs.push_back({{name_of_program(file->plain(program.attribute("Source"))),
                                          file->mark_of_tag(program)}});
        if (!task.programs.empty()) to.project.tasks.push_back(std::move(task));
    }
    in_c.tell(to.out);
}

}  // namespace lineshaft::projects
