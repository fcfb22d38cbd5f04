#include "runtime/st/check/checking.hpp"

#include "runtime/st/check/calls.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

Nothing Checking::fail(const char* code, Place place, std::string message, std::string help) {
    out.add(code, place.mark(), std::move(message), std::move(help));
    return {};
}

void Checking::warn(const char* code, Place place, std::string message, std::string help) {
    if (!place.source->is_users() || !out.keeps_warnings())
        return;  // a place is counted out in long files
    out.warn(code, place.mark(), std::move(message), std::move(help));
}

namespace {

/// A name that the checker has put in for others means nothing where they stand.
bool is_written(Place at, std::string_view name) {
    if (!at.source || !at.source->is_users()) return false;
    std::string_view text = at.text();
    if (text.starts_with('#')) text.remove_prefix(1);
    if (text.starts_with('"')) text = text.substr(1, text.size() - 2);
    return same_name(text, name.substr(name.rfind('.') + 1)) || same_name(text, name);
}

/// `T` of `a.b.T`.
Place last_part(Place name) {
    const std::string_view text = name.text();
    if (!text.ends_with('"')) name.begin += static_cast<std::uint32_t>(text.rfind('.') + 1);
    return name;
}

}  // namespace

void Checking::note(Place at, const Variable& variable) {
    if (uses && is_written(at, variable.text))
        uses->push_back({last_part(at), variable.name.place, &variable, nullptr, variable.type});
}

void Checking::note(Place at, const Routine& called) {
    if (uses && is_written(at, called.name))
        uses->push_back({last_part(at), called.pou->name.place, nullptr, &called, called.type});
}

void Checking::note(Place at, const Type& type, Place declared) {
    if (uses && at.source && at.source->is_users())
        uses->push_back({last_part(at), declared, nullptr, nullptr, &type});
}

void Checking::note(Place at, const NamedType& named) {
    if (named.type) note(at, *named.type, named.declaration->name.place);
}

void Checking::note_value(Place at, const Type& enumeration, std::size_t value) {
    if (!uses || !is_written(at, enumeration.values[value])) return;
    const Place declared = value < enumeration.places.size() ? enumeration.places[value] : Place();
    uses->push_back({last_part(at), declared, nullptr, nullptr, &enumeration, value});
}

const Prefixes* Checking::prefixes_at(Place place) const {
    const auto all = prefixes.find(place.source);
    if (all == prefixes.end()) return nullptr;
    const auto is_around = [&](const Prefixes& one) {
        return one.scope->begin <= place.begin && place.begin < one.scope->end;
    };
    const auto innermost = std::find_if(all->second.rbegin(), all->second.rend(), is_around);
    return innermost == all->second.rend() ? nullptr : &*innermost;
}

namespace {

/// What SCL names without quotes, and so do LAD and FBD by their boxes: a function of the standard,
/// a conversion, or a kind of block.
bool is_instruction(const Checking& c, std::string_view name) {
    return find_standard_function(name) || is_conversion_name(name) ||
           c.catalog.find(standard_type_name(name));
}

/// A block of the user's whose name is declared in quotes, and stands without them here.
bool is_without_its_quotes(const Token& name, const Token& declared) {
    return is_instruction_name(name) && declared.quoted && !is_prelude(declared) &&
           !is_library(declared);
}

}  // namespace

Routine* Checking::find_routine(const Token& name) {
    Routine* found = look_up(&Names::routines, name);
    if (!found || !is_without_its_quotes(name, found->pou->name)) return found;
    Routine* of_prelude = find_in(prelude.routines, name.text);
    return of_prelude || is_instruction(*this, name.text) ? of_prelude : found;
}

bool Checking::is_lost(const Token& name) const {
    const bool* is_name = find_in(tree.lost, name.text.substr(name.text.rfind('.') + 1));
    return is_name && *is_name && !is_prelude(name);
}

bool Checking::may_be_foreign(const Token& name) {
    if (missing_libraries.empty()) return false;
    foreign.emplace(name.text, name.place);
    checked.foreign_users.insert(name.place.source);
    return true;
}

Type& Checking::make_type(Type::Kind kind, std::string name) {
    Type& type = checked.types.emplace_back();
    type.kind = kind;
    type.name = std::move(name);
    type.slots = 0;
    return type;
}

Variable& Checking::make_variable(Routine& of, const Token& at, std::string_view text,
                                  const Type* type) {
    Variable& made = of.variables.emplace_back();
    made.name = at;
    made.text = text;
    made.type = type;
    made.of = of.pou;
    made.used = true;
    return made;
}

Variable& Checking::make_variable(const Token& at, std::string_view text, const Type* type) {
    Variable& made = checked.variables.emplace_back();
    made.name = at;
    made.text = text;
    made.type = type;
    return made;
}

Routine& Checking::make_routine(Pou& pou, std::string name) {
    Routine& made = checked.routines.emplace_back();
    made.pou = &pou;
    made.name = std::move(name);
    note(pou.name.place, made);
    return made;
}

}  // namespace lineshaft::st
