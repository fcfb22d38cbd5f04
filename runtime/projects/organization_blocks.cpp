#include "runtime/projects/organization_blocks.hpp"

#include <algorithm>
#include <charconv>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/cursor.hpp"

namespace lineshaft::projects {

namespace {

using st::Word;
using enum OrganizationBlock::Start;

/// The first has what is called `Main` or by a name of the user.
struct Event {
    OrganizationBlock::Start start;
    std::string_view name, type;       ///< in small letters
    std::int64_t first = 0, last = 0;  ///< numbers
};
constexpr Event events[] = {
    {cycle, "main", "programcycle", 1, 1},
    {startup, "startup", "startup", 100, 102},
    {cyclic_interrupt, "cyclic interrupt", "cyclicinterrupt", 30, 38},
    {event, "time of day", "timeofday", 10, 17},
    {event, "time delay interrupt", "timedelayinterrupt", 20, 23},
    {event, "hardware interrupt", "hardwareinterrupt", 40, 47},
    {event, "status", "status", 55, 55},
    {event, "update", "update", 56, 56},
    {event, "profile", "profile", 57, 57},
    {event, "synchronous cycle", "synchronouscycle", 61, 64},
    {event, "time error interrupt", "timeerrorinterrupt", 80, 80},
    {event, "diagnostic error interrupt", "diagnosticerrorinterrupt", 82, 82},
    {event, "pull or plug of modules", "pullorplugofmodules", 83, 83},
    {event, "rack or station failure", "rackorstationfailure", 86, 86},
    {event, "programming error", "programmingerror", 121, 121},
    {event, "io access error", "ioaccesserror", 122, 122},
};

const Event* event_of_number(std::int64_t number) {
    const auto* it = std::ranges::find_if(
        events, [&](const Event& e) { return number >= e.first && number <= e.last; });
    return it == std::end(events) ? nullptr : it;
}

/// `Cyclic interrupt`, `Cyclic interrupt_1`.
const Event* event_of_name(std::string_view name) {
    const auto* it = std::ranges::find_if(events, [&](const Event& e) {
        return name.starts_with(e.name) &&
               (name.size() == e.name.size() || name[e.name.size()] == '_');
    });
    return it == std::end(events) ? nullptr : it;
}

/// 35 of `OB35`, `OB 35`, `OB35_Control` and `Control_OB35`; 0 of others.
std::int64_t number_in(std::string_view name) {
    for (std::size_t at = name.find("ob"); at != name.npos; at = name.find("ob", at + 1)) {
        if (at > 0 && is_letter(name[at - 1])) continue;
        std::size_t digits = at + 2;
        if (digits < name.size() && (name[digits] == ' ' || name[digits] == '_')) ++digits;
        std::int64_t number = 0;
        std::from_chars(name.data() + digits, name.data() + name.size(), number);
        if (number > 0) return number;
    }
    return 0;
}

/// What stands before its first statement.
struct Header {
    bool is_restart = false;  ///< by its title
    bool is_startup = false, is_cyclic_interrupt = false;
};

Header read_header(st::Cursor& p) {
    Header header;
    while (!p.is(Word::end_of_file) && !p.is(Word::begin_) &&
           !p.is(Word::end_organization_block_)) {
        header.is_restart |= p.says("complete restart");
        header.is_startup |= p.says("lostretentive");
        header.is_cyclic_interrupt |= p.says("event_count");
        p.take();
    }
    return header;
}

}  // namespace

OrganizationBlock organization_block(Name name, std::int64_t number, std::string_view type) {
    const std::string small = lower(name.text);
    if (number == 0) number = number_in(small);
    const auto* typed = std::ranges::find(events, lower(type), &Event::type);
    const Event* found = typed != std::end(events) ? typed : event_of_number(number);
    if (!found) found = event_of_name(small);
    return {std::move(name), found ? found->start : cycle, number};
}

void read_organization_blocks(const Reading& to, const std::shared_ptr<const SourceFile>& source) {
    if (upper(source->text).find("ORGANIZATION_BLOCK") == std::string::npos) return;
    Diagnostics unread;
    st::Cursor p{st::read_tokens(source, unread)};
    while (!p.is(Word::end_of_file)) {
        if (p.take().word != Word::organization_block_ || !p.is_name()) continue;
        const st::Token name = p.take();
        OrganizationBlock made = organization_block({std::string(name.text), name.place.mark()}, 0);
        const Header header = read_header(p);
        if (made.start == cycle && (header.is_startup || header.is_restart)) made.start = startup;
        if (made.start == cycle && header.is_cyclic_interrupt) made.start = cyclic_interrupt;
        to.project.organization_blocks.push_back(std::move(made));
    }
}

}  // namespace lineshaft::projects
