#include "runtime/projects/configuration.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/cursor.hpp"

namespace lineshaft::projects {

namespace {

using st::Token;
using st::Word;

Name name_of(const Token& token) {
    return {std::string(token.text), token.place.mark()};
}

/// `TASK slow(INTERVAL := T#20ms, PRIORITY := 1);`
ProjectTask read_task(st::Cursor& p) {
    p.take();
    ProjectTask made{.name = name_of(p.take())};
    while (!p.is(Word::close) && !p.is(Word::semicolon) && !p.is(Word::end_of_file)) {
        const Token key = p.take();
        if (!p.accept(Word::assign)) continue;
        const st::Place begin = p.here().place;
        while (!p.is(Word::comma) && !p.is(Word::close) && !p.is(Word::end_of_file)) p.take();
        const std::string_view value = begin.to(p.last().place).text();
        if (st::same_name(key.text, "interval")) made.every = interval_of(value);
        if (st::same_name(key.text, "single") || st::same_name(key.text, "event"))
            made.event = value;
        if (st::same_name(key.text, "priority"))
            std::from_chars(value.data(), value.data() + value.size(), made.priority);
    }
    return made;
}

/// `Main(limit := 5, done => lamp)`: what is given is a literal, as a program's file has it.
void read_arguments(st::Cursor& p, TaskProgram& to) {
    if (!p.accept(Word::open)) return;
    while (!p.is(Word::close) && !p.is(Word::semicolon) && !p.is(Word::end_of_file)) {
        const Token key = p.take();
        if (!p.accept(Word::assign)) continue;
        const st::Place begin = p.here().place;
        while (!p.is(Word::comma) && !p.is(Word::close) && !p.is(Word::end_of_file)) p.take();
        const std::string value = lower(begin.to(p.last().place).text());
        const bool is_number = value.find_first_not_of("-.0123456789") == value.npos;
        if (is_number || value == "true" || value == "false")
            to.given.emplace_back(key.text, value);
    }
}

/// `PROGRAM main WITH slow : Main(limit := 5);`
void read_program(st::Cursor& p, std::vector<ProjectTask>& tasks) {
    p.take();
    while (p.is(Word::retain_) || p.is(Word::non_retain_)) p.take();
    const std::string instance(p.take().text);
    if (!p.says("with")) return;
    p.take();
    const Token task = p.take();
    if (!p.accept(Word::colon)) return;
    const auto is_its = [&](const ProjectTask& one) {
        return st::same_name(one.name.text, task.text);
    };
    const auto found = std::ranges::find_if(tasks, is_its);
    if (found == tasks.end()) return;
    TaskProgram& program = found->programs.emplace_back(TaskProgram{name_of(p.take()), instance});
    read_arguments(p, program);
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
        ProjectTask task = read_task(p);
        task.is_free = task.every == 0 && task.event.empty();
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
    while (!p.is(Word::end_of_file)) {
        if (p.is_name() && p.says("task") && p.is_name(1) && p.next(2).word == Word::open)
            tasks.push_back(read_task(p));
        else if (p.is(Word::program_))
            read_program(p, tasks);
        else
            p.take();
    }
    to.project.tasks.insert(to.project.tasks.end(), tasks.begin(), tasks.end());
}

}  // namespace lineshaft::projects
