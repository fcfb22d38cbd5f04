#include "runtime/projects/configuration.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/cursor.hpp"

namespace lineshaft::projects {

namespace {

using st::Token;
using st::Word;

Name name_of(const Token& token) {
    return {std::string(token.text), token.place.mark()};
}

/// How long a variable is that a task names as its interval, as its declaration in the same file
/// says; 0: it does not.
std::int64_t interval_of_variable(const st::Cursor& p, std::string_view name) {
    for (std::size_t i = 0; i + 3 < p.tokens.size(); ++i) {
        const bool is_it = st::same_name(p.tokens[i].text, name) &&
                           p.tokens[i + 1].word == Word::colon &&
                           p.tokens[i + 3].word == Word::assign;
        if (!is_it) continue;
        std::size_t end = i + 4;
        while (end + 1 < p.tokens.size() && p.tokens[end + 1].word != Word::semicolon) ++end;
        return interval_of(p.tokens[i + 4].place.to(p.tokens[end].place).text());
    }
    return 0;
}

/// Up to what follows a value, without it.
std::string_view take_value(st::Cursor& p) {
    const st::Place begin = p.here().place;
    while (!p.is(Word::comma) && !p.is(Word::close) && !p.is(Word::end_of_file)) p.take();
    return begin.to(p.last().place).text();
}

/// `TASK slow(INTERVAL := T#20ms, PRIORITY := 1);`, or `SINGLE := go` for what starts it.
ProjectTask read_task(st::Cursor& p, const std::string& resource) {
    p.take();
    ProjectTask made{.name = name_of(p.take()), .resource = resource, .counts_always = true};
    while (!p.is(Word::close) && !p.is(Word::semicolon) && !p.is(Word::end_of_file)) {
        const Token key = p.take();
        if (!p.accept(Word::assign)) continue;
        const Token first = p.here();
        const std::string_view value = take_value(p);
        if (st::same_name(key.text, "interval")) {
            made.every = interval_of(value);
            if (made.every == 0) made.every = interval_of_variable(p, value);
        }
        if (st::same_name(key.text, "single") && !st::same_name(value, "false"))
            made.event = {{std::string(value), first.place.mark()}, true};
        if (st::same_name(key.text, "event"))
            made.event = {{std::string(value), first.place.mark()}};
        if (st::same_name(key.text, "priority"))
            std::from_chars(value.data(), value.data() + value.size(), made.priority);
    }
    return made;
}

/// `Main(limit := 5, done => lamp, motor WITH quick)`: what is given is a literal, as a program's
/// file has it; the compiler connects the others.
void read_arguments(st::Cursor& p, TaskProgram& to) {
    if (!p.accept(Word::open)) return;
    while (!p.is(Word::close) && !p.is(Word::semicolon) && !p.is(Word::end_of_file)) {
        const Token key = p.take();
        if (p.is_name() && p.says("with") && p.is_name(1)) {
            p.take();
            to.apart.emplace_back(name_of(key), p.take().text);
        }
        if (!p.accept(Word::assign)) continue;
        const std::string value = lower(take_value(p));
        const bool is_number = value.find_first_not_of("-.0123456789") == value.npos;
        if (is_number || value == "true" || value == "false")
            to.given.emplace_back(key.text, value);
    }
}

/// What runs the program of a RESOURCE; without a task again and again.
ProjectTask& task_of(std::vector<ProjectTask>& tasks, const Token* name,
                     const std::string& resource) {
    const auto find = [&](bool here) {
        return std::ranges::find_if(tasks, [&](const ProjectTask& one) {
            return (!here || one.resource == resource) && one.is_background == !name &&
                   (!name || st::same_name(one.name.text, name->text));
        });
    };
    auto found = find(true);
    if (found == tasks.end()) found = name ? find(false) : found;
    if (found != tasks.end()) return *found;
    return tasks.emplace_back(ProjectTask{.name = name ? name_of(*name) : Name{},
                                          .resource = resource,
                                          .is_background = !name,
                                          .counts_always = true});
}

/// `PROGRAM main WITH slow : Main(limit := 5);`. MatIEC calls programs that are due at once as they
/// stand in the RESOURCE, and does not look at PRIORITY.
void read_program(st::Cursor& p, const std::string& resource, const std::string& configuration,
                  std::vector<ProjectTask>& tasks) {
    p.take();
    while (p.is(Word::retain_) || p.is(Word::non_retain_)) p.take();
    const Token instance = p.take();
    const bool has_task = p.says("with");
    if (has_task) p.take();
    const Token task = has_task ? p.take() : p.here();
    if (!p.accept(Word::colon)) return;
    TaskProgram program{name_of(p.take())};
    program.instance = instance.text;
    const std::string& around = resource.empty() ? configuration : resource;
    program.path = (around.empty() ? "" : around + ".") + program.instance;
    read_arguments(p, program);
    ProjectTask& to = task_of(tasks, has_task ? &task : nullptr, resource);
    const auto has_programs = [](const ProjectTask& one) { return !one.programs.empty(); };
    if (instance.place.dialect().programs_run_as_written && to.programs.empty())
        to.priority = std::ranges::count_if(tasks, has_programs);
    to.programs.push_back(std::move(program));
}

/// A task that no TASK declares would never be due.
void refuse_undeclared(const Reading& to, const std::vector<ProjectTask>& tasks,
                       const std::vector<std::string>& declared) {
    for (const ProjectTask& task : tasks) {
        const auto is_it = [&](const std::string& name) {
            return st::same_name(name, task.name.text);
        };
        if (task.is_background || std::ranges::any_of(declared, is_it)) continue;
        to.out.add(code::unknown_task, task.name.mark,
                   fmt::format("no TASK '{}' is declared", task.name.text),
                   suggest(task.name.text, declared));
    }
}

/// A block of a program that another task runs stays in its program here.
void warn_of_parts(const Reading& to, const std::vector<ProjectTask>& tasks) {
    for (const ProjectTask& task : tasks)
        for (const TaskProgram& program : task.programs)
            for (const auto& [part, name] : program.apart)
                to.out.warn(code::not_supported, part.mark,
                            fmt::format("'{}' runs where {} calls it, not in the task '{}'",
                                        part.text, program.text, name),
                            "let a PROGRAM of that task have it, and call it there");
}

/// `PLC_PRG();` and its like, up to END_TASK.
void read_calls(st::Cursor& p, ProjectTask& task) {
    p.accept(Word::close);
    p.accept(Word::semicolon);
    while (!p.says("end_task") && !p.is(Word::end_of_file)) {
        if (p.is_name()) task.programs.push_back({name_of(p.here())});
        while (!p.says("end_task") && !p.is(Word::end_of_file) && !p.accept(Word::semicolon))
            p.take();
    }
}

constexpr std::string_view resource_end = "END_RESOURCE";

/// What stands between RESOURCE and END_RESOURCE, at its places; all else is blank.
std::string resources_of(const std::string& text) {
    std::string made(text.size(), ' ');
    for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
        made[at] = '\n';
    constexpr std::string_view word = "RESOURCE";
    for (std::size_t end = text.find(resource_end), from = 0; end != text.npos;
         from = end + resource_end.size(), end = text.find(resource_end, from)) {
        const std::size_t begin = text.rfind(word, end - 1);
        if (begin == text.npos || begin < from) continue;
        const std::size_t first = begin + word.size();
        made.replace(first, end - first, text, first, end - first);
    }
    return made;
}

}  // namespace

void read_tasks_of_export(const Reading& to, const SourceFile& source) {
    if (source.text.find(resource_end) == std::string::npos) return;
    SourceFile made = source;
    made.text = resources_of(source.text);
    Diagnostics unread;
    st::Cursor p{st::read_tokens(std::make_shared<const SourceFile>(std::move(made)), unread)};
    while (!p.is(Word::end_of_file)) {
        if (!p.says("task") || !p.is_name(1)) {
            p.take();
            continue;
        }
        ProjectTask task = read_task(p, {});
        task.counts_always = false;
        task.event.is_edge = false;
        task.is_free = task.every == 0 && task.event.text.empty();
        read_calls(p, task);
        const auto is_known = [&](const ProjectTask& other) {
            return st::same_name(other.name.text, task.name.text);
        };
        if (std::ranges::none_of(to.project.tasks, is_known))
            to.project.tasks.push_back(std::move(task));
    }
}

std::int64_t interval_of(std::string_view text) {
    struct Unit {
        std::string_view name;
        double ns;
    };
    static constexpr Unit units[] = {{"ms", 1e6},   {"us", 1e3}, {"ns", 1}, {"d", 86400e9},
                                     {"h", 3600e9}, {"m", 60e9}, {"s", 1e9}};
    std::string small = lower(text);
    std::erase(small, '_');
    std::string_view rest = small;
    for (const std::string_view prefix : {"pt", "time#", "t#"})
        if (rest.starts_with(prefix)) rest.remove_prefix(prefix.size());
    double sum = 0;
    while (!rest.empty()) {
        double number = 0;
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
        if (error != std::errc()) return 0;
        rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
        if (rest.empty()) return std::llround(std::clamp((sum + number * 1e9), 0.0, 1e18));
        const auto* unit =
            std::ranges::find_if(units, [&](const Unit& u) { return rest.starts_with(u.name); });
        if (unit == std::end(units)) return 0;
        rest.remove_prefix(unit->name.size());
        sum += number * unit->ns;
    }
    return std::llround(std::clamp(sum, 0.0, 1e18));
}

void read_configuration(const Reading& to, const std::shared_ptr<const SourceFile>& source) {
    if (upper(source->text).find("CONFIGURATION") == std::string::npos) return;
    Diagnostics unread;
    st::Cursor p{st::read_tokens(source, unread)};
    while (!p.is(Word::end_of_file) && !p.is(Word::configuration_)) p.take();
    std::vector<ProjectTask> tasks;
    std::vector<std::string> declared;
    std::string configuration, resource;
    bool is_within = false;
    while (!p.is(Word::end_of_file)) {
        if (p.is(Word::configuration_) || p.says("end_configuration"))
            is_within = p.is(Word::configuration_);
        const bool is_task = p.is_name() && p.says("task") && p.is_name(1);
        if (is_task) declared.emplace_back(p.next().text);
        if (is_task && p.next(2).word == Word::open) {
            tasks.push_back(read_task(p, resource));
        } else if (p.is(Word::program_) && is_within) {
            read_program(p, resource, configuration, tasks);
        } else {
            if (p.is(Word::configuration_) && p.is_name(1)) configuration = p.next().text;
            if (p.says("resource") && p.is_name(1)) resource = p.next().text;
            if (p.says("end_resource")) resource.clear();
            p.take();
        }
    }
    refuse_undeclared(to, tasks, declared);
    warn_of_parts(to, tasks);
    std::ranges::move(tasks, std::back_inserter(to.project.tasks));
}

}  // namespace lineshaft::projects
