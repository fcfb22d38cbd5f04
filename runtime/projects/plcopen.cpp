#include "runtime/projects/plcopen.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>

#include <fmt/format.h>

#include "runtime/projects/configuration.hpp"
#include "runtime/projects/plcopen_text.hpp"
#include "runtime/projects/standard_xml.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

/// What it writes beside the standard's is named by 3S. Without a header it may be a part of such.
bool is_of_codesys(const XmlFile& file) {
    const bool has_header = !file.root().child("fileHeader").empty();
    return !has_header || file.text().find("3s-software") != std::string_view::npos ||
           file.text().find("CODESYS") != std::string_view::npos;
}

/// In the namespace of IEC 61131-10's XML, which Sysmac Studio writes.
constexpr std::string_view of_standard = "TC65SC65BWG7TF10";

/// One project of PLCopen XML.
class PlcopenProject {
  public:
    /// What is not CODESYS' has the dialect of `read_as`.
    PlcopenProject(const XmlFile& file, const Reading& to, bool is_of_matiec,
                   std::string_view read_as = ".matiec")
        : file_(file),
          declared_(declared_types(file)),
          to_(to),
          is_of_matiec_(is_of_matiec),
          read_as_(read_as) {}

    void read() {
        const pugi::xml_node root = file_.root();
        const pugi::xml_node types = root.child("types");
        for (const pugi::xml_node type : types.child("dataTypes").children("dataType"))
            add(type, &PlcopenText::add_type);
        for (const pugi::xml_node pou : types.child("pous").children("pou"))
            add(pou, &PlcopenText::add_pou);
        for (const pugi::xml_node configuration :
             root.child("instances").child("configurations").children("configuration")) {
            globals_of(configuration);
            for (const pugi::xml_node resource : configuration.children("resource")) {
                globals_of(resource);
                for (const pugi::xml_node task : resource.children("task")) add_task(task);
                add_background(resource);
                data_of(resource);
            }
        }
        data_of(root);
    }

  private:
    void add(pugi::xml_node element, void (PlcopenText::*add_to)(pugi::xml_node)) {
        PlcopenText text(file_, declared_, is_of_matiec_);
        (text.*add_to)(element);
        SourceFile made = *text.finish(element);
        if (is_of_matiec_) made.read_as = read_as_;
        to_.project.add(std::make_shared<const SourceFile>(std::move(made)));
    }

    void globals_of(pugi::xml_node owner) {
        for (const pugi::xml_node list : owner.children("globalVars"))
            add(list, &PlcopenText::add_globals);
    }

    void declared_in(pugi::xml_node data) {
        globals_of(data);
        for (const pugi::xml_node type : data.children("dataType"))
            add(type, &PlcopenText::add_type);
        for (const pugi::xml_node type : data.children("union")) add(type, &PlcopenText::add_union);
        for (const pugi::xml_node pou : data.children("pou")) add(pou, &PlcopenText::add_pou);
        for (const pugi::xml_node interface : data.children("Interface"))
            add(interface, &PlcopenText::add_interface_of_blocks);
    }

    /// CODESYS has there what it has in an application.
    void data_of(pugi::xml_node owner) {
        for (const pugi::xml_node data : owner.child("addData").children("data")) {
            declared_in(data);
            for (const pugi::xml_node resource : data.children("resource")) {
                globals_of(resource);
                for (const pugi::xml_node task : resource.children("task")) add_task(task);
                data_of_application(resource);
            }
        }
    }

    void data_of_application(pugi::xml_node resource) {
        for (const pugi::xml_node data : resource.child("addData").children("data"))
            declared_in(data);
    }

    /// `Interval="10000" IntervalUnit="us"` of CODESYS.
    std::int64_t interval_of_settings(pugi::xml_node settings) const {
        const std::string interval = file_.plain(settings.attribute("Interval"));
        const bool has_unit = !interval.empty() && is_letter(interval.back());
        return interval_of(has_unit ? interval
                                    : interval + file_.plain(settings.attribute("IntervalUnit")));
    }

    void read_settings(pugi::xml_node task, ProjectTask& to) const {
        for (const pugi::xml_node data : task.child("addData").children("data")) {
            const pugi::xml_node settings = data.child("TaskSettings");
            const std::string kind = file_.plain(settings.attribute("KindOfTask"));
            if (kind == "Cyclic" && to.every == 0) to.every = interval_of_settings(settings);
            if (kind.empty() || kind == "Cyclic") continue;
            to.every = 0;
            to.is_free = kind == "Freewheeling";
            for (const char* const of : {"ExternalEvent", "Event"})
                if (const pugi::xml_attribute event = settings.attribute(of))
                    to.event = {{file_.plain(event), file_.mark(file_.part(event))}};
        }
    }

    void add_task(pugi::xml_node task) {
        const std::string priority = file_.plain(task.attribute("priority"));
        ProjectTask made{.name = {file_.plain(task.attribute("name")),
                                  file_.mark(file_.part(task.attribute("name")))}};
        std::from_chars(priority.data(), priority.data() + priority.size(), made.priority);
        if (is_of_matiec_ && read_as_ == ".matiec")  // which calls programs as they stand there
            made.priority = std::ssize(to_.project.tasks);
        made.every = interval_of(file_.plain(task.attribute("interval")));
        read_settings(task, made);
        const pugi::xml_attribute single = task.attribute("single");
        if (const std::string named = file_.plain(single); !named.empty())
            made.event = {{named, file_.mark(file_.part(single))}, true};
        add_programs(task, made);
        to_.project.tasks.push_back(std::move(made));
    }

    /// Programs that stand in no task.
    void add_background(pugi::xml_node resource) {
        ProjectTask made{.name = {}, .is_background = true, .counts_always = true};
        add_programs(resource, made);
        if (!made.programs.empty()) to_.project.tasks.push_back(std::move(made));
    }

    void add_programs(pugi::xml_node owner, ProjectTask& to) const {
        for (const pugi::xml_node instance : owner.children("pouInstance")) {
            const pugi::xml_attribute type = instance.attribute("typeName");
            const bool is_typed = !file_.plain(type).empty();
            const pugi::xml_attribute named = is_typed ? type : instance.attribute("name");
            TaskProgram& program = to.programs.emplace_back(
                TaskProgram{{file_.plain(named), file_.mark(file_.part(named))}});
            if (is_typed) program.instance = file_.plain(instance.attribute("name"));
        }
    }

    const XmlFile& file_;
    const DeclaredTypes declared_;
    const Reading& to_;
    const bool is_of_matiec_;
    const std::string_view read_as_;
};

}  // namespace

/// Looked into, which is not reading it: who writes there replaces nothing that is read.
bool is_plcopen(const std::filesystem::path& file) {
    std::string start(4096, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    std::erase(start, '\0');
    return start.find("plcopen.org/xml/tc6") != std::string::npos ||
           start.find(of_standard) != std::string::npos;
}

void read_plcopen(const Reading& to, const std::string& path, const Mark& where) {
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    file->remove_prefix();
    if (is_standard_xml(*file)) {
        const auto made = XmlFile::parse(plcopen_of_standard_xml(*file, to.out), to.out);
        if (made) PlcopenProject(*made, to, true, ".st").read();
        return;
    }
    if (std::string_view(file->root().name()) != "project")
        return to.out.add(code::not_an_object, file->mark_of_tag(file->root()),
                          fmt::format("<{}> is no project of PLCopen XML", file->root().name()),
                          "its files begin with <project>");
    PlcopenProject(*file, to, !is_of_codesys(*file)).read();
}

void read_plcopen_of_matiec(const Reading& to, const XmlFile& file) {
    PlcopenProject(file, to, true).read();
}

}  // namespace lineshaft::projects
