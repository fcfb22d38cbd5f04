#include <algorithm>
#include <chrono>

#include "runtime/source/letters.hpp"
#include "runtime/source/units.hpp"
#include "runtime/st/check/checker_class.hpp"
#include "runtime/st/vendors/instead.hpp"

namespace lineshaft::st {

namespace {

constexpr Wide most_elements = 1 << 24;

std::string quoted(std::string_view name) {
    return fmt::format("'{}'", name);
}

/// What the standard's and Siemens' counters count in, by the number of `data_type`.
constexpr std::string_view counter_types[] = {"int",   "dint", "lint",  "udint",
                                              "ulint", "sint", "usint", "uint"};

/// A kind of the catalogue that counts in one of them.
struct Counter {
    std::string_view kind;
    std::size_t type = 0;
};

/// `CTU`, `CTD_UDINT`, `IEC_DCOUNTER`.
std::optional<Counter> find_counter(std::string_view name) {
    static constexpr std::pair<std::string_view, std::size_t> siemens[] = {
        {"iec_counter", 0},  {"iec_dcounter", 1},  {"iec_udcounter", 3},
        {"iec_scounter", 5}, {"iec_uscounter", 6}, {"iec_ucounter", 7}};
    for (const auto& [own, type] : siemens)
        if (same_name(name, own)) return Counter{"ctu", type};
    const std::size_t end = std::min(name.find('_'), name.size());
    for (const std::string_view kind : {"ctu", "ctd", "ctud"}) {
        if (!same_name(name.substr(0, end), kind)) continue;
        if (end == name.size()) return Counter{kind};
        for (std::size_t type = 0; type < std::size(counter_types); ++type)
            if (same_name(name.substr(end + 1), counter_types[type])) return Counter{kind, type};
    }
    return {};
}

constexpr std::pair<std::string_view, std::string_view> aliases[] = {
    {"ton_time", "ton"},  {"tof_time", "tof"}, {"tp_time", "tp"},    {"ton_ltime", "ton"},
    {"tof_ltime", "tof"}, {"tp_ltime", "tp"},  {"iec_timer", "ton"}, {"iec_ltimer", "ton"}};

/// What Siemens and CODESYS call references.
constexpr std::pair<std::string_view, std::string_view> handles[] = {
    {"to_axis", "axis_ref"},
    {"to_speedaxis", "axis_ref"},
    {"to_positioningaxis", "axis_ref"},
    {"to_synchronousaxis", "axis_ref"},
    {"axis_ref_sm3", "axis_ref"},
    {"axis_ref_virtual_sm3", "axis_ref"},
    {"to_cam", "cam_ref"}};

/// What the numbers mean that Siemens' MC_MOVEABSOLUTE and MC_MOVEVELOCITY have for a Direction,
/// and MC_HOME for its Mode.
std::vector<std::int64_t> numbers_of(std::string_view field) {
    if (field == "Direction") return {0, 1, 2, 0};
    if (field == "HomingMode") return {0, -1, -1, -1, -1, -1, -1, 0};
    return {};
}

/// Enumerations that the standards make a WORD.
constexpr std::string_view code_names[] = {"errorid", "axiserrorid", "error_id", "warning_id"};

Section section_of(Direction direction) {
    if (direction == Direction::output) return Section::output;
    if (direction == Direction::local) return Section::local;
    return direction == Direction::in_out ? Section::in_out : Section::input;
}

}  // namespace

Checked check(Tree& tree, const Catalog& standard, Diagnostics& out) {
    return Checker(tree, standard, out).check();
}

Checked Checker::check() {
    collect_names();
    declare_globals();
    declare_routines();
    check_initial_values();
    for (Routine& routine : checked_.routines) check_body(routine);
    put_in_order();
    if (out_.empty()) warn_of_unused();
    return std::move(checked_);
}

Type& Checker::make_type(Kind kind, std::string name) {
    Type& type = checked_.types.emplace_back();
    type.kind = kind;
    type.name = std::move(name);
    type.slots = 0;
    return type;
}

Routine& Checker::make_routine(Pou& pou, std::string name) {
    Routine& routine = checked_.routines.emplace_back();
    routine.pou = &pou;
    routine.name = std::move(name);
    return routine;
}

bool Checker::is_new_name(Token name, NameMap<Place>& names, bool is_test) {
    const auto [it, added] = names.emplace(name.text, name.place);
    if (added) return true;
    const Mark first = it->second.mark();
    const bool beside = first.file == *name.place.file;
    const std::string help =
        fmt::format("first in {}{}", beside ? "line " : first.file->path + ":", first.line);
    if (is_test)
        out_.warn("L0909", name.place.mark(), "two TESTs have one name", help);
    else
        fail("L0909", name.place, fmt::format("{} is declared twice", quoted(name.text)), help);
    return false;
}

void Checker::collect_names() {
    for (const TypeDeclaration& declared : tree_.types)
        if (Names& names = names_beside(declared.name); is_new_name(declared.name, names.places))
            names.types.emplace(declared.name.text, NamedType{&declared});
    for (Pou* pou : tree_.units) {
        has_tests_ |= pou->is_tests;
        Names& all = names_beside(pou->name);
        const bool added = is_new_name(pou->name, all.places);
        if (pou->kind == PouKind::data_block) continue;
        Routine& routine = make_routine(*pou, std::string(pou->name.text));
        if (added) all.routines.emplace(pou->name.text, &routine);
        if (routine.is_function()) continue;
        routine.type = &make_type(Kind::block, routine.name);
        routine.type->routine = &routine;
        NameMap<Place> names;
        for (Pou* method : pou->methods) {
            const std::string name(method->name.text);
            Routine& made = make_routine(*method, pou->is_tests ? name : routine.name + "." + name);
            made.owner = &routine;
            const bool is_test = pou->is_tests && method->name.word != Word::setup_ &&
                                 method->name.word != Word::teardown_;
            if (is_new_name(method->name, names, is_test) && !is_test)
                routine.methods.emplace(method->name.text, &made);
        }
    }
    for (const DeclarationBlock& block : tree_.globals)
        for (const Declaration* declared : block.declarations)
            if (block.constant) constants_.emplace(declared->name.text, declared);
    for (const TypeDeclaration& declared : tree_.types)
        if (NamedType* type = look_up(&Names::types, declared.name)) resolve_declared(*type);
}

Variable* Checker::add(std::deque<Variable>& to, const Declaration& declared, const Type* type) {
    Variable& variable = to.emplace_back();
    variable.name = declared.name;
    variable.text = declared.name.text;
    variable.type = type;
    variable.initial = declared.initial;
    variable.doc = declared.doc;
    check_unit(variable, declared);
    return &variable;
}

void Checker::check_unit(Variable& variable, const Declaration& declared) {
    if (declared.unit.empty()) return;
    variable.unit = declared.unit;
    if (!Unit::parse(variable.unit))
        fail("L0304", declared.unit_place, fmt::format("{} is not a unit", quoted(declared.unit)),
             "lineshaft units lists them");
}

/// All that stands in VAR_GLOBAL.
Type& Checker::global_variables() {
    if (checked_.globals.empty())
        checked_.globals.push_back({"globals", &make_type(Kind::structure, "globals")});
    return const_cast<Type&>(*checked_.globals.front().type);
}

Variable* Checker::declare_global(const Declaration& declared, bool constant, bool retain) {
    Type& all = global_variables();
    const Type* type = resolve(*declared.type);
    if (!is_new_name(declared.name, users_.places)) return nullptr;
    Variable* variable = add(checked_.variables, declared, type);
    if (type && type->kind == Kind::handle) return declare_object(*variable);
    variable->section = Section::global;
    variable->constant = constant;
    variable->retain = retain;
    variable->space = Space::global;
    variable->global = 0;
    if (constant) make_constant(*variable);
    if (variable->space != Space::constant) all.members.push_back(variable);
    globals_.emplace(declared.name.text, variable);
    return variable;
}

/// `VAR_GLOBAL Axis_1 : AXIS_REF`: the program has the block.
Variable* Checker::declare_object(Variable& variable) {
    if (variable.type->kind == Kind::handle) variable.type = object_type(*variable.type);
    variable.section = Section::global;
    variable.space = Space::global;
    variable.global = static_cast<int>(checked_.globals.size());
    checked_.globals.push_back({std::string(variable.text), variable.type, nullptr, &variable});
    globals_.emplace(variable.text, &variable);
    return &variable;
}

/// One that a type or another constant asks for, wherever it is declared; null when there is none,
/// or it asks for itself, or over too many others.
Variable* Checker::declare_early(std::string_view name) {
    constexpr int most_hops = 200;
    const auto it = constants_.find(name);
    if (it == constants_.end() || hops_ == most_hops || !begun_constants_.insert(it->second).second)
        return nullptr;
    ++hops_;
    Variable* variable = declare_global(*it->second, true, false);
    --hops_;
    return variable;
}

void Checker::declare_globals() {
    for (const DeclarationBlock& block : tree_.globals)
        for (const Declaration* declared : block.declarations)
            if (!block.constant || begun_constants_.insert(declared).second)
                declare_global(*declared, block.constant, block.retain);
    constants_.clear();
    for (Pou* pou : tree_.units) {
        if (pou->kind != PouKind::data_block) continue;
        const int number = static_cast<int>(checked_.globals.size());
        const Type* type = nullptr;
        if (pou->base) {
            type = resolve(*pou->base);
        } else {
            Type& made = make_type(Kind::structure, std::string(pou->name.text));
            for (const DeclarationBlock& block : pou->blocks)
                for (const Declaration* declared : block.declarations) {
                    made.members.push_back(
                        add(checked_.variables, *declared, resolve(*declared->type)));
                    made.members.back()->retain = block.retain;
                }
            type = &made;
        }
        Variable& variable = checked_.variables.emplace_back();
        variable.name = pou->name;
        variable.text = pou->name.text;
        variable.type = type;
        variable.section = Section::global;
        variable.space = Space::global;
        variable.global = number;
        checked_.globals.push_back({std::string(pou->name.text), type, pou});
        globals_.emplace(pou->name.text, &variable);
    }
}

void Checker::declare_routines() {
    for (Routine& routine : checked_.routines) {
        routine_ = &routine;
        declare_result(routine);
        for (const bool constant : {true, false})  // bounds may name what stands further down
            for (const DeclarationBlock& block : routine.pou->blocks)
                if ((block.constant && block.section == Section::local) == constant)
                    declare(routine, block);
    }
    routine_ = nullptr;
    for (Routine& method : checked_.routines)  // it works on what its block is made of
        if (method.owner) {
            const Routine& owner = *method.owner;
            method.calls.insert(method.calls.end(), owner.calls.begin(), owner.calls.end());
            method.call_places.insert(method.call_places.end(), owner.call_places.begin(),
                                      owner.call_places.end());
        }
}

void Checker::declare_result(Routine& routine) {
    const TypeText* text = routine.pou->result;
    if (!text || same_name(text->name.text, "void")) return;
    if (routine.has_instances()) {
        fail("L0914", text->place, "only functions and methods have a result",
             "declare a VAR_OUTPUT");
        return;
    }
    Variable& result = routine.variables.emplace_back();
    result.name = routine.pou->name;
    result.text = result.name.text;
    result.type = resolve(*text);
    result.section = Section::result;
    result.of = routine.pou;
    result.used = true;
    routine.result = &result;
    routine.names.emplace(result.text, &result);
}

void Checker::declare(Routine& routine, const DeclarationBlock& block) {
    for (const Declaration* declared : block.declarations) {
        const Type* type = resolve(*declared->type);
        if (block.section == Section::in_out && type == &string_type) type = &open_string_type;
        Variable* variable = add(routine.variables, *declared, type);
        variable->section = block.section;
        variable->constant = block.constant;
        variable->retain = block.retain;
        variable->of = routine.pou;
        if (block.section == Section::in_out && !(type && type->is_handle()))
            variable->space = Space::reference;
        const auto [it, added] = routine.names.emplace(variable->text, variable);
        if (!added)
            fail("L0909", declared->name.place,
                 fmt::format("{} is declared twice", quoted(variable->text)),
                 it->second->section == Section::result
                     ? "the function's own name is that of its result"
                     : fmt::format("first in line {}", it->second->name.place.mark().line));
        if (type && type->is_instance() && !routine.has_instances() && !routine.is_test() &&
            block.section != Section::in_out)
            fail("L0914", declared->name.place,
                 "a function keeps nothing from call to call, so it has no instances",
                 "pass the instance as VAR_IN_OUT");
        depend(type, declared->name.place);
        if (routine.pou->is_tests || routine.is_test()) make_object(*variable);
        if (block.constant && block.section != Section::input) make_constant(*variable);
        if (declared->edge.word != Word::end_of_file)
            declare_edge(routine, *variable, declared->edge);
    }
}

/// `go : BOOL R_EDGE` has an instance beside it, which nobody can name.
void Checker::declare_edge(Routine& routine, Variable& variable, const Token& edge) {
    const bool fits = variable.type && variable.type->kind == Kind::boolean &&
                      variable.section == Section::input && routine.has_instances();
    if (!fits) {
        fail("L0914", edge.place,
             fmt::format("{} is for a BOOL of VAR_INPUT of a function block or a program",
                         edge.text),
             "declare an instance of R_TRIG or F_TRIG, and call it");
        return;
    }
    Variable& instance = routine.variables.emplace_back();
    instance.name = edge;
    instance.text = checked_.names.emplace_back(fmt::format("{}.{}", variable.text, edge.text));
    instance.type = standard_type(same_name(edge.text, "r_edge") ? "r_trig" : "f_trig");
    instance.of = routine.pou;
    instance.used = true;
    routine.names.emplace(instance.text, &instance);
    variable.edge = &instance;
}

/// What a test has of a kind that others refer to, such as an axis, is a block of its own.
void Checker::make_object(Variable& variable) {
    if (!variable.type || !variable.type->is_object()) return;
    Type& own = checked_.types.emplace_back(*variable.type);
    own.initial_value = variable.initial;
    variable.type = &own;
    variable.space = Space::global;
    variable.global = static_cast<int>(checked_.globals.size());
    checked_.globals.push_back({std::string(variable.text), &own});
}

/// A constant scalar takes no memory.
void Checker::make_constant(Variable& variable) {
    if (variable.type && variable.type->is_instance())
        fail("L0914", variable.name.place,
             "an instance changes when it is called, so it is no constant",
             "declare it in VAR, without CONSTANT");
    if (!variable.type || !variable.type->is_scalar()) return;
    variable.space = Space::constant;
    if (!variable.initial) {
        variable.value = variable.type->initial;
        if (is_scl(variable.name.place)) return;
        fail("L0913", variable.name.place,
             fmt::format("the constant {} has no value", quoted(variable.text)),
             "write ':= value' behind its type");
        return;
    }
    auto* value = const_cast<Expression*>(variable.initial);
    check_initial(value, *variable.type);
    if (value->kind == Expression::Kind::constant) variable.value = value->constant;
}

/// The routine runs, or is made of, what is in `type`.
void Checker::depend(const Type* type, Place place) {
    if (!type || !routine_) return;
    if (type->kind == Kind::array) return depend(type->element, place);
    if (type->kind == Kind::structure)
        for (const Variable* member : type->members) depend(member->type, place);
    if (type->kind != Kind::block) return;
    const auto add_call = [&](Routine* routine) {
        routine_->calls.push_back(routine);
        routine_->call_places.push_back(place);
    };
    add_call(type->routine);
    for (const Pou* method : type->routine->pou->methods)
        if (const auto it = type->routine->methods.find(method->name.text);
            it != type->routine->methods.end())
            add_call(it->second);
}

// Initial values.

void Checker::check_initial_values() {
    const auto check_one = [&](const Variable& variable) {
        if (!variable.initial || !variable.type || variable.space == Space::constant) return;
        auto* value = const_cast<Expression*>(variable.initial);
        check_initial(value, *variable.type);
        const_cast<Variable&>(variable).initial = value;
    };
    for (Variable& variable : checked_.variables) check_one(variable);
    for (const Global& global : checked_.globals) check_data_block(global);
    for (Routine& routine : checked_.routines) {
        routine_ = &routine;
        for (const Variable& variable : routine.variables) {
            if (variable.initial && variable.section == Section::in_out)
                fail("L0914", variable.name.place, "a VAR_IN_OUT has no initial value",
                     "leave ':= ...' out; the caller gives the variable");
            check_one(variable);
        }
    }
    routine_ = nullptr;
}

/// What stands behind BEGIN of a data block: assignments of constants to its parts.
void Checker::check_data_block(const Global& global) {
    if (!global.pou || !global.type) return;
    Routine parts;
    parts.pou = global.pou;
    for (Variable* member : global.type->members) parts.names.emplace(member->text, member);
    if (global.type->kind == Kind::block) parts.names = global.type->routine->names;
    routine_ = &parts;
    for (Statement* s : global.pou->body) {
        if (s->kind != Statement::Kind::assign || s->op != Word::assign) {
            fail("L0914", s->place, "a data block has no code",
                 "assign constants, and write statements in a block");
            continue;
        }
        const Type* type = check(*s->target);
        if (!is_constant_place(*s->target))
            fail("L0913", s->target->place, "the index is not a constant");
        if (type) check_initial(s->value, *type);
    }
    routine_ = nullptr;
}

bool Checker::is_constant_place(const Expression& place) const {
    for (const Argument& index : place.arguments)
        if (index.value->kind != Expression::Kind::constant) return false;
    return !place.operands[0] || is_constant_place(*place.operands[0]);
}

void Checker::check_initial(Expression*& value, const Type& type) {
    if (is_dtl(type) && value->token.word == Word::duration)
        if (!(value = list_of_dtl(*value, type))) return;
    if (value->kind == Expression::Kind::list) {
        value->type = &type;
        const bool is_structure = value->is_structure();
        if (type.kind == Kind::array && !is_structure) return check_elements(*value, type);
        if ((type.kind == Kind::structure || type.is_instance()) && is_structure)
            return check_members(*value, type);
        fail("L0905", value->place, fmt::format("this is not a value of {}", describe(type)),
             type.kind == Kind::array ? "write its elements in brackets: [1, 2, 3]"
             : type.is_real()         ? "write a decimal point: 1.5"
                                      : "");
        return;
    }
    if (value->kind == Expression::Kind::repeated && type.kind == Kind::array) {
        Expression* list = make(Expression::Kind::list, *value);
        list->arguments.push_back({{}, false, value, nullptr});
        value = list;
        return check_initial(value, type);
    }
    if (value->type) return;  // of `a, b : INT := 5`, seen before
    if (!check(*value, &type)) return;
    evaluate(*value);
    if (!coerce(value, type)) return;
    if (!evaluate(*value) && value->type)
        fail("L0913", value->place, "an initial value is a constant",
             "assign it in the body, behind IF NOT started");
}

/// `DTL#2020-02-29-12:30:15` as its parts.
Expression* Checker::list_of_dtl(const Expression& literal, const Type& type) {
    const auto value = read_dtl(literal);
    if (!value) return nullptr;
    using namespace std::chrono;
    const sys_time<nanoseconds> moment(nanoseconds(static_cast<std::int64_t>(*value)));
    const auto day = floor<days>(moment);
    const year_month_day date(day);
    const hh_mm_ss clock(moment - day);
    const Wide parts[] = {int{date.year()},        unsigned{date.month()},
                          unsigned{date.day()},    weekday(day).c_encoding() + 1,
                          clock.hours().count(),   clock.minutes().count(),
                          clock.seconds().count(), clock.subseconds().count()};
    Expression* list = make(Expression::Kind::list, literal);
    for (std::size_t i = 0; i < type.members.size(); ++i) {
        Expression* part = make(Expression::Kind::constant, literal);
        become(*part, *type.members[i]->type, {.integer = parts[i]});
        list->arguments.push_back({.name = type.members[i]->name, .value = part});
    }
    return list;
}

/// Of several dimensions either a list of lists, or all elements in one, the last index first.
void Checker::check_elements(Expression& list, const Type& array) {
    const bool nested = list.is_nested();
    const Type& element = nested ? *array.element : array.innermost();
    Wide room = Wide{array.upper} - array.lower + 1;
    for (const Type* inner = &array; !nested && inner->has_inner; inner = inner->element)
        room *= Wide{inner->element->upper} - inner->element->lower + 1;
    Wide count = 0;
    for (Argument& argument : list.arguments) {
        Expression* value = argument.value;
        if (value->kind != Expression::Kind::repeated) {
            check_initial(argument.value, element);
            ++count;
            continue;
        }
        const auto times = check_whole(value->operands[0], lint_type);
        for (Argument& repeated : value->arguments) check_initial(repeated.value, element);
        const Wide one = static_cast<Wide>(std::max<std::size_t>(value->arguments.size(), 1));
        if (times && *times >= 0 && *times <= most_elements) count += *times * one;
    }
    if (count > room)
        fail("L0908", list.place,
             fmt::format("{} values for {} elements", static_cast<std::int64_t>(count),
                         static_cast<std::int64_t>(room)),
             "leave some out, or make the array larger");
}

/// By name, or of a structure by position.
void Checker::check_members(Expression& list, const Type& type) {
    const bool by_place =
        type.kind == Kind::structure && std::ranges::none_of(list.arguments, &Argument::is_named);
    if (by_place && list.arguments.size() > type.members.size())
        return (void)fail(
            "L0908", list.place,
            fmt::format("{} values for {} members", list.arguments.size(), type.members.size()),
            "leave some out");
    for (std::size_t i = 0; by_place && i < list.arguments.size(); ++i) {
        Variable& member = *type.members[i];
        list.arguments[i].variable = &member;
        if (member.type) check_initial(list.arguments[i].value, *member.type);
    }
    for (Argument& argument : list.arguments) {
        if (by_place) break;
        if (argument.name.word == Word::end_of_file) {
            fail("L0905", argument.value->place, "this value has no name",
                 fmt::format("name the member of {}: (name := value)", describe(type)));
            continue;
        }
        std::vector<std::string> names;
        const auto& members = type.members;
        for (const Variable* member : members) names.emplace_back(member->text);
        Variable* found = nullptr;
        if (type.kind == Kind::block) {
            const auto it = type.routine->names.find(argument.name.text);
            if (it != type.routine->names.end()) found = it->second;
        }
        for (Variable* member : members)
            if (same_name(member->text, argument.name.text)) found = member;
        argument.variable = found;
        if (!found) {
            fail("L0904", argument.name.place,
                 fmt::format("{} has no '{}'", describe(type), argument.name.text),
                 suggest(argument.name.text, names));
        } else if (found->type) {
            check_initial(argument.value, *found->type);
        }
    }
}

// Types.

const Type* Checker::resolve(const TypeText& text) {
    switch (text.kind) {
        case TypeText::Kind::name:
            return resolve_name(text.name);
        case TypeText::Kind::array:
            return resolve_array(text);
        case TypeText::Kind::structure:
            return resolve_structure(text);
        case TypeText::Kind::enumeration:
            return resolve_enumeration(text);
        case TypeText::Kind::subrange:
            return resolve_subrange(text);
        case TypeText::Kind::text:
            return resolve_text(text);
    }
    return nullptr;
}

const Type* Checker::resolve_name(const Token& name) {
    if (is_lost(name)) return nullptr;
    if (const Type* type = find_elementary(name.text); type && !name.quoted) return type;
    if (NamedType* type = look_up(&Names::types, name)) return resolve_declared(*type);
    if (const Routine* routine = find_routine(name)) {
        if (routine->type) return routine->type;
        return fail("L0905", name.place, fmt::format("'{}' is a function, not a type", name.text),
                    "call it; only function blocks have instances");
    }
    if (const Type* type = standard_type(name.text)) return type;
    if (tree_.lost.contains(name.text)) return nullptr;
    if (const std::string_view instead = instead_of_type(name.text); !instead.empty())
        return fail("L0903", name.place, fmt::format("the type {} is not supported", name.text),
                    std::string(instead));
    std::vector<std::string> names = {"BOOL", "INT",  "DINT",  "LINT", "UINT",  "UDINT",
                                      "WORD", "REAL", "LREAL", "TIME", "STRING"};
    for (const auto& [known, type] : users_.types) names.emplace_back(known);
    for (const auto& [known, routine] : users_.routines)
        if (routine->type) names.emplace_back(known);
    for (const BlockType& kind : standard_.types()) names.emplace_back(kind.name);
    std::ranges::sort(names);
    const auto near = nearest(name.text, names);
    return fail(
        "L0904", name.place, fmt::format("'{}' is not a type", name.text),
        near.empty() ? "declare it with TYPE, or as a FUNCTION_BLOCK" : suggest(name.text, near));
}

const Type* Checker::resolve_declared(NamedType& named) {
    if (named.type) return named.type;
    const TypeDeclaration& declared = *named.declaration;
    if (named.visiting)
        return fail("L0911", declared.name.place,
                    fmt::format("the type '{}' contains itself", declared.name.text),
                    "a value of it would have no end");
    named.visiting = true;
    const Type* type = resolve(*declared.type);
    named.visiting = false;
    if (!type) return nullptr;
    const bool is_own = declared.type->kind != TypeText::Kind::name;
    if (is_own) {
        auto& own = const_cast<Type&>(*type);
        own.name = std::string(declared.name.text);
        own.is_unnamed = false;
    }
    if (declared.initial) {
        Type& copy = checked_.types.emplace_back(*type);
        copy.initial_value = declared.initial;
        type = &copy;
        auto* value = const_cast<Expression*>(declared.initial);
        check_initial(value, copy);
        copy.initial_value = value;
    }
    auto& values = names_beside(declared.name).values;
    for (std::size_t i = 0; i < type->values.size() && is_own; ++i) {
        const auto [it, is_new] = values.emplace(type->values[i], NamedValue{type, i});
        if (!is_new) it->second.ambiguous = true;
    }
    if (declared.initial)
        for (auto& [name, value] : values)
            if (value.type && value.type->name == type->name) value.type = type;
    return named.type = type;
}

const Type* Checker::resolve_array(const TypeText& text) {
    const Type* element = resolve(*text.element);
    Wide total = 1;
    for (auto it = text.ranges.rbegin(); it != text.ranges.rend(); ++it) {
        Expression *from = it->first, *to = it->second;
        const auto lower = check_whole(from, lint_type), upper = check_whole(to, lint_type);
        if (!lower || !upper) return nullptr;
        const Wide count = *upper - *lower + 1;
        if (count < 1)
            return fail("L0908", from->place.to(to->place), "the array has no element",
                        "the first bound is the smaller one");
        total *= count;
        if (total > most_elements)
            return fail("L0912", from->place.to(to->place), "the array is too large",
                        "an array has at most 16777216 elements");
        Type& array = make_type(Kind::array, {});
        array.lower = static_cast<std::int64_t>(*lower);
        array.upper = static_cast<std::int64_t>(*upper);
        array.element = element;
        array.has_inner = it != text.ranges.rbegin();
        if (element) element = &array;
    }
    return element;
}

const Type* Checker::resolve_structure(const TypeText& text) {
    Type& type = make_type(Kind::structure, "STRUCT");
    type.is_unnamed = true;
    NameMap<Place> names;
    for (const Declaration* declared : text.members) {
        const Type* member = resolve(*declared->type);
        if (is_new_name(declared->name, names))
            type.members.push_back(add(checked_.variables, *declared, member));
    }
    return &type;
}

const Type* Checker::resolve_enumeration(const TypeText& text) {
    Type& type = make_type(Kind::enumeration, "enumeration");
    type.slots = 1;
    type.base = &int_type;
    if (text.name.word != Word::end_of_file) type.base = resolve_name(text.name);
    if (type.base && type.base->kind != Kind::integer && type.base->kind != Kind::bits)
        return fail("L0903", text.place, "arguments behind a type are not supported",
                    "write values behind ':=': (name := value)");
    NameMap<Place> names;
    std::int64_t number = 0;
    for (const Argument& value : text.values) {
        if (Expression* given = value.value)
            if (const auto whole = check_whole(given, type.base ? *type.base : int_type))
                number = static_cast<std::int64_t>(*whole);
        if (!is_new_name(value.name, names)) continue;
        type.counted &= number == static_cast<std::int64_t>(type.values.size());
        type.values.emplace_back(value.name.text);
        type.numbers.push_back(number++);
    }
    return &type;
}

const Type* Checker::resolve_subrange(const TypeText& text) {
    const Type* base = resolve_name(text.name);
    if (!base) return nullptr;
    if (base->kind != Kind::integer)
        return fail("L0905", text.place, fmt::format("{} has no subranges", describe(*base)),
                    "a subrange is one of an integer type");
    Expression *from = text.ranges.front().first, *to = text.ranges.front().second;
    const auto lower = check_whole(from, *base), upper = check_whole(to, *base);
    if (!lower || !upper) return nullptr;
    if (*lower > *upper)
        return fail("L0908", text.place, "the subrange has no value",
                    "the first bound is the smaller one");
    Type& type = checked_.types.emplace_back(*base);
    type.name = fmt::format("{}({}..{})", base->name, static_cast<std::int64_t>(*lower),
                            static_cast<std::int64_t>(*upper));
    type.is_subrange = true;
    type.base = base;
    type.lower = static_cast<std::int64_t>(*lower);
    type.upper = static_cast<std::int64_t>(*upper);
    type.initial.integer = *lower;  // 6.4.4.4
    return &type;
}

const Type* Checker::resolve_text(const TypeText& text) {
    Expression* length = text.length;
    const auto whole = check_whole(length, lint_type);
    if (!whole) return nullptr;
    if (*whole < 1 || *whole > longest_text)
        return fail("L0908", length->place, "a STRING has between 1 and 32767 characters");
    Type& type = make_type(Kind::text, fmt::format("STRING[{}]", static_cast<int>(*whole)));
    type.length = static_cast<std::uint32_t>(*whole);
    return &type;
}

const Type* Checker::handle_type(std::string_view name) {
    const auto kind = std::ranges::find_if(standard_.types(), [&](const BlockType& type) {
        return !type.handle.empty() && same_name(type.handle, name);
    });
    if (kind == standard_.types().end()) return nullptr;
    Type& type = make_type(Kind::handle, std::string(kind->handle));
    type.standard = &*kind;
    type.slots = 1;
    type.initial.integer = -1;
    return standard_types_[type.name] = &type;
}

const Type* Checker::standard_type(std::string_view name) {
    if (const auto it = standard_types_.find(name); it != standard_types_.end()) return it->second;
    for (const auto& [theirs, ours] : handles)
        if (same_name(theirs, name)) return standard_type(ours);
    if (const Type* handle = handle_type(name)) return handle;
    const auto counter = find_counter(name);
    const auto* alias =
        std::ranges::find_if(aliases, [&](const auto& a) { return same_name(a.first, name); });
    std::string_view wanted = name;
    if (counter) wanted = counter->kind;
    if (alias != std::end(aliases)) wanted = alias->second;
    const auto kind = std::ranges::find_if(
        standard_.types(), [&](const BlockType& type) { return same_name(type.name, wanted); });
    if (kind == standard_.types().end() || kind->is_device()) return nullptr;
    Type& type = make_type(Kind::standard, upper(name));
    type.standard = &*kind;
    type.slots = static_cast<std::uint32_t>((kind->size + 7) / 8) + (has_tests_ ? 1 : 0);
    for (const Field& field : kind->fields) {
        Variable& member = checked_.variables.emplace_back();
        member.text = field.name;
        member.section = section_of(field.direction);
        member.slot = static_cast<std::uint32_t>(field.offset / 8);
        member.byte = static_cast<std::uint32_t>(field.offset);
        member.is_byte = field.type == lineshaft::Type::boolean;
        member.type = field.type == lineshaft::Type::boolean ? &bool_type
                      : field.type == lineshaft::Type::real  ? &lreal_type
                      : field.unit == "ns"                   ? &time_type
                                                             : &lint_type;
        const BlockType* referred = standard_.find(field.refers);
        if (referred && !referred->handle.empty()) member.type = standard_type(referred->handle);
        if (field.type == lineshaft::Type::enumeration) {
            Type& values =
                make_type(Kind::enumeration, fmt::format("{}.{}", kind->name, field.name));
            values.slots = 1;
            values.base = &lint_type;
            values.of_number = numbers_of(field.name);
            values.is_code = std::ranges::any_of(
                code_names, [&](std::string_view code) { return same_name(field.name, code); });
            for (const std::string_view value : field.names) {
                values.numbers.push_back(static_cast<std::int64_t>(values.values.size()));
                values.values.emplace_back(value);
            }
            member.type = &values;
        }
        const bool counts = same_name(field.name, "pv") || same_name(field.name, "cv");
        if (counter && counts) member.type = find_elementary(counter_types[counter->type]);
        type.members.push_back(&member);
    }
    if (counter) type.presets.push_back({"data_type", {.integer = Wide(counter->type)}});
    return standard_types_[type.name] = &type;
}

// The order of routines.

void Checker::put_in_order() {
    std::vector<const Routine*> path;
    for (Routine& routine : checked_.routines) visit(routine, path);
}

void Checker::visit(Routine& routine, std::vector<const Routine*>& path) {
    if (routine.state == Routine::State::done) return;
    routine.state = Routine::State::visiting;
    path.push_back(&routine);
    for (std::size_t i = 0; i < routine.calls.size(); ++i) {
        Routine& called = *routine.calls[i];
        if (called.state != Routine::State::visiting) {
            visit(called, path);
            continue;
        }
        std::string hops;
        for (auto it = std::ranges::find(path, &called); it != path.end(); ++it)
            hops += fmt::format("{} -> ", (*it)->name);
        fail("L0911", routine.call_places[i],
             fmt::format("'{}' calls itself: {}{}", called.name, hops, called.name),
             "a PLC has no stack that grows: write a loop");
    }
    path.pop_back();
    routine.state = Routine::State::done;
    checked_.order.push_back(&routine);
}

void Checker::warn_of_unused() {
    for (const Routine& routine : checked_.routines)
        for (const Variable& variable : routine.variables)
            if (!variable.used && !routine.is_test() && !routine.pou->is_tests &&
                (variable.section == Section::local || variable.section == Section::temp))
                out_.warn("L0921", variable.name.place.mark(),
                          fmt::format("'{}' is declared and never used", variable.text),
                          "remove it");
}

}  // namespace lineshaft::st
