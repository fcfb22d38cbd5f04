#include "tests/twin/c_writer.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include <fmt/format.h>

#include "runtime/st/functions/standard.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using E = Expression::Kind;
using S = Statement::Kind;

std::string small(std::string_view name) {
    std::string text(name);
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
}

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) out += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    return out + "\"";
}

std::string real_constant(double value) {
    if (std::isnan(value)) return "__builtin_nan(\"\")";
    if (std::isinf(value)) return value < 0 ? "(-__builtin_inf())" : "__builtin_inf()";
    return fmt::format("({:a})", value);
}

/// The flag of a routine that a caller may take; not a variable of that name.
bool is_eno(const Variable& variable) {
    return variable.section == Section::temp && variable.text == "ENO";
}

bool is_input(const Variable& variable) {
    return variable.section == Section::input || variable.section == Section::in_out;
}

class CWriter {
  public:
    CWriter(const Checked& checked, const Routine& main, int number)
        : checked_(checked), main_(main), prefix_(fmt::format("p{}_", number)) {}

    std::string write() {
        for (std::size_t i = 0; i < checked_.globals.size(); ++i) {
            const Type& type = *checked_.globals[i].type;
            if (type.kind != Kind::block && !is_image(i)) declare(type);
            for (const Variable* member : type.members)
                global_parts_.emplace(member, static_cast<int>(i));
        }
        for (const Routine* routine : checked_.order)
            if (routine->has_instances() && !routine->owner) declare(*routine->type);
        for (std::size_t i = 0; i < checked_.globals.size(); ++i)
            if (is_image(i))
                put("static u8 {}image[{}];", prefix_, checked_.image.bytes + 8);
            else
                put("static {} {}g{};", c_type(*checked_.globals[i].type), prefix_, i);
        for (const Variable* variable : checked_.image.variables) declare(*variable->type);
        for (const Routine& routine : checked_.routines)
            if (routine.is_prototype() && routine.owner) announce(routine);
        for (const Routine* routine : checked_.order)
            if (!routine->is_prototype()) announce(*routine);
        for (const Routine* routine : checked_.order)
            if (has_body(*routine))
                write(*routine);
            else if (!routine->is_prototype())
                put("{} {{ __builtin_trap(); }}", head(*routine, false));
        for (const Routine* routine : dispatched_) write_dispatch(*routine);
        write_ends();
        return std::move(out_);
    }

  private:
    bool is_image(std::size_t global) const {
        return checked_.image.global == static_cast<int>(global);
    }

    template <class... T>
    void put(fmt::format_string<T...> format, T&&... values) {
        fmt::format_to(std::back_inserter(out_), format, std::forward<T>(values)...);
        out_ += '\n';
    }

    // Types.

    std::string c_type(const Type& type) {
        switch (type.kind) {
            case Kind::boolean:
                return "u8";
            case Kind::integer:
            case Kind::bits:
                return fmt::format("{}{}", type.is_signed ? 'i' : 'u', type.bits);
            case Kind::real:
                return type.bits == 32 ? "f32" : "f64";
            case Kind::any_real:
                return "f64";
            case Kind::any_bits:
                return "u64";
            case Kind::time:
            case Kind::date:
            case Kind::clock:
            case Kind::moment:
            case Kind::enumeration:
            case Kind::any_integer:
                return "i64";
            case Kind::reference:
                return "pointer";
            case Kind::interface:
                return "block*";
            case Kind::union_:
                return fmt::format("union {}t{}", prefix_, number_of(&type));
            case Kind::standard:
                return "struct " + small(type.standard->name);
            default:
                return fmt::format("struct {}t{}", prefix_, number_of(&type));
        }
    }

    int number_of(const void* what) {
        return numbers_.emplace(what, static_cast<int>(numbers_.size())).first->second;
    }

    std::string name_of(const Variable& variable) {
        if (!variable.of && variable.name.text.empty()) return std::string(variable.text);
        return fmt::format("v{}", number_of(&variable));
    }

    void declare(const Type& type) {
        if (type.is_reference()) {
            if (!type.element->is_instance()) declare(*type.element);
            return;
        }
        if (type.is_scalar() || type.kind == Kind::standard || declared_[&type]) return;
        declared_[&type] = true;
        std::string inside;
        const auto add = [&](const Variable& variable) {
            if (variable.space != Space::frame && variable.space != Space::reference &&
                variable.space != Space::global)
                return;
            const bool reference = variable.space == Space::reference;
            if (!reference || variable.type->kind != Kind::block) declare(*variable.type);
            inside += fmt::format("{} {}{}; ", c_type(*variable.type), reference ? "*" : "",
                                  name_of(variable));
        };
        if (type.kind == Kind::text)
            inside = fmt::format("i64 length; char c[{}];", (type.length + 7) / 8 * 8);
        if (type.kind == Kind::array) {
            declare(*type.element);
            inside = fmt::format("{} e[{}];", c_type(*type.element), type.upper - type.lower + 1);
        }
        for (const Variable* member : type.members) add(*member);
        if (type.kind == Kind::block) {
            inside += "i64 kind; ";
            for (const Routine* level : levels_of(*type.routine)) {
                for (const Variable& variable : level->variables) add(variable);
                inside += fmt::format("i64 {}; ", mark_of(*level));
                for (const Routine* method : level->own_methods)
                    inside += fmt::format("i64 {}; ", mark_of(*method));
            }
        }
        put("{} {{ {} }};", c_type(type), inside);
        write_begin(type);
        write_dump(type);
    }

    /// A block begins as its base does, whose base is the first.
    static std::vector<const Routine*> levels_of(const Routine& block) {
        std::vector<const Routine*> levels;
        for (const Routine* level = &block; level; level = level->base)
            levels.insert(levels.begin(), level);
        return levels;
    }

    /// What says in which scan a routine of an instance runs.
    std::string mark_of(const Routine& routine) {
        return fmt::format("runs{}", number_of(&routine));
    }

    /// How a value begins.
    void write_begin(const Type& type) {
        if (type.kind == Kind::text) return;
        put("static COLD void {}begin{}({}* p) {{", prefix_, number_of(&type), c_type(type));
        const auto member = [&](const Variable& variable) {
            if (variable.space != Space::frame && variable.space != Space::global) return;
            begin(variable, "p->" + name_of(variable));
        };
        if (type.kind == Kind::array) {
            put("for (int k = 0; k < {}; ++k) {{", type.upper - type.lower + 1);
            begin("p->e[k]", *type.element);
            put("}}");
        } else if (type.kind == Kind::block) {
            put("memset(p, 0, sizeof *p);\np->kind = {};", number_of(&type));
            for (const Variable* variable : all_variables(*type.routine)) member(*variable);
        } else {
            if (type.kind == Kind::union_) put("memset(p, 0, sizeof *p);");
            for (const Variable* variable : type.members)
                if (type.kind != Kind::union_)
                    member(*variable);
                else
                    begin_part(*variable);
        }
        if (type.initial_value) give("(*p)", type, *type.initial_value);
        put("}}");
    }

    /// A part of a UNION that begins with nothing but 0 says nothing of bytes that others share.
    void begin_part(const Variable& variable) {
        put("{{ {} part;", c_type(*variable.type));
        begin(variable, "part");
        put("if (twin_is_set(&part, sizeof part)) p->{} = part; }}", name_of(variable));
    }

    void begin(const Variable& variable, const std::string& place) {
        begin(place, *variable.type);
        if (variable.initial) give(place, *variable.type, *variable.initial);
    }

    void begin(const std::string& place, const Type& type) {
        if (type.kind == Kind::text) {
            put("{}.length = 0;", place);
        } else if (type.kind == Kind::standard) {
            put("memset(&{0}, 0, sizeof {0});", place);
            for (const auto& [name, value] : type.presets)
                put("{}.{} = {};", place, name, static_cast<std::int64_t>(value.integer));
        } else if (type.is_reference()) {
            put("{} = (pointer){{0, 0, 0}};", place);
        } else if (type.is_scalar()) {
            put("{} = {};", place, constant(type, type.initial));
        } else {
            put("{}begin{}(&{});", prefix_, number_of(&type), place);
            return;
        }
        if (type.initial_value) give(place, type, *type.initial_value);
    }

    /// What an initial value writes.
    void give(const std::string& place, const Type& type, const Expression& value) {
        if (value.kind == E::constant && type.kind == Kind::text) {
            put("twin_literal(&{}, {}, {}, {});", place, type.length, quoted(value.constant.text),
                value.constant.text.size());
        } else if (value.kind == E::constant) {
            put("{} = {};", place, constant(type, value.constant));
        } else if (type.kind == Kind::array) {
            give_elements(place, type, value);
        } else {
            for (const Argument& argument : value.arguments)
                give(place + "." + name_of(*argument.variable), *argument.variable->type,
                     *argument.value);
        }
    }

    void give_elements(const std::string& place, const Type& type, const Expression& list) {
        const bool nested = list.is_nested();
        const Type& element = nested ? *type.element : type.innermost();
        std::int64_t at = 0;
        const auto one = [&](const Expression& value) {
            give(fmt::format("(({}*)&{})[{}]", c_type(element), place, at++), element, value);
        };
        for (const Argument& argument : list.arguments) {
            const Expression& value = *argument.value;
            if (value.kind != E::repeated) {
                one(value);
                continue;
            }
            const auto times = static_cast<std::int64_t>(value.operands[0]->constant.integer);
            if (value.arguments.empty()) at += times;
            for (std::int64_t i = 0; i < times; ++i)
                for (const Argument& repeated : value.arguments) one(*repeated.value);
        }
    }

    void write_dump(const Type& type) {
        if (type.kind == Kind::text) return;
        put("static COLD u64* {}dump{}(const {}* p, u64* to) {{", prefix_, number_of(&type),
            c_type(type));
        if (type.kind == Kind::array) {
            put("for (int k = 0; k < {}; ++k) {{", type.upper - type.lower + 1);
            dump("p->e[k]", *type.element);
            put("}}");
        }
        if (type.kind == Kind::block)
            for (const Variable* variable : all_variables(*type.routine))
                if (variable->space == Space::frame)
                    dump("p->" + name_of(*variable), *variable->type);
        if (type.kind == Kind::union_) put("to = twin_put_bytes(to, p, sizeof *p);");
        if (type.kind == Kind::structure)
            for (const Variable* member : type.members)
                dump("p->" + name_of(*member), *member->type);
        put("return to;\n}}");
    }

    void dump(const std::string& place, const Type& type) {
        if (type.is_reference() || type.kind == Kind::interface) return;
        if (type.kind == Kind::text)
            put("to = twin_put_text(to, &{});", place);
        else if (type.kind == Kind::standard)
            for (const Variable* member : type.members)
                put("to = twin_put(to, {}.{});", place, name_of(*member));
        else if (type.is_real())
            put("to = twin_put_real(to, {});", place);
        else if (type.is_scalar())
            put("to = twin_put(to, (i64){});", place);
        else
            put("to = {}dump{}(&{}, to);", prefix_, number_of(&type), place);
    }

    std::string constant(const Type& type, const Constant& value) {
        if (type.is_real()) return fmt::format("({}){}", c_type(type), real_constant(value.real));
        return fmt::format("({}){:#x}u", c_type(type), static_cast<std::uint64_t>(value.integer));
    }

    // Routines.

    std::string name_of(const Routine& routine) {
        return fmt::format("{}f{}", prefix_, number_of(&routine));
    }

    /// The body of an ABSTRACT block is one, which SUPER^() calls; an ABSTRACT method has none.
    static bool has_body(const Routine& routine) {
        return !routine.is_prototype() && !(routine.owner && routine.pou->is_abstract);
    }

    static bool has_instance(const Routine& routine) {
        return routine.has_instances() || routine.owner;
    }

    /// What is no scalar is given and returned by its address: clang loses bytes of a struct in
    /// which a number stands across two words.
    static bool is_by_address(const Type& type) {
        return !type.is_scalar() && !type.is_reference();
    }

    std::string returned_type(const Variable* result) {
        return result && !is_by_address(*result->type) ? c_type(*result->type) : "void";
    }

    /// `dispatches`: what finds the method of the instance that is given.
    std::string head(const Routine& routine, bool dispatches) {
        std::string parameters;
        const auto add = [&](const std::string& text) {
            parameters += (parameters.empty() ? "" : ", ") + text;
        };
        const bool is_block = routine.has_instances();
        const Routine* block = is_block ? &routine : routine.owner;
        if (block) add((dispatches ? "block" : c_type(*block->type)) + "* self");
        for (const Variable& v : routine.variables) {
            if (is_block || v.space == Space::constant) continue;
            if (v.section == Section::input)
                add(c_type(*v.type) + (is_by_address(*v.type) ? "* in_" : " ") + name_of(v));
            if (v.section == Section::in_out) add(c_type(*v.type) + "* " + name_of(v));
            if (v.section == Section::output) add(c_type(*v.type) + "* out_" + name_of(v));
        }
        const Variable* result = routine.result;
        if (result && is_by_address(*result->type)) add(c_type(*result->type) + "* returned");
        return fmt::format("static {} {}({})", returned_type(result),
                           dispatches ? dispatch_of(routine) : name_of(routine),
                           parameters.empty() ? "void" : parameters);
    }

    void announce(const Routine& routine) {
        for (const Variable& variable : routine.variables)
            if (variable.space != Space::constant) declare(*variable.type);
        if (!routine.is_prototype()) put("{};", head(routine, false));
        if (has_instance(routine)) put("{};", head(routine, true));
    }

    std::string dispatch_of(const Routine& routine) {
        return fmt::format("{}d{}", prefix_, number_of(&routine));
    }

    /// The method of that name that stands nearest to the block, on the way to its first base.
    static const Routine* nearest(const Routine& block, const Routine& wanted) {
        for (const Routine* level = &block; level; level = level->base)
            for (const Routine* method : level->own_methods)
                if (same_name(method->pou->name.text, wanted.pou->name.text) &&
                    method->pou->accessor == wanted.pou->accessor)
                    return method;
        return nullptr;
    }

    /// What `wanted` was given, for `found`, whose types are equal and have C names of their own.
    std::string passed_on(const Routine& wanted, const Routine& found) {
        std::vector<std::string> types;
        for (const Variable& v : found.variables)
            if (v.space != Space::constant && (is_input(v) || v.section == Section::output))
                types.push_back(c_type(*v.type));
        std::string given;
        for (const Variable& v : wanted.variables) {
            if (v.space == Space::constant || !(is_input(v) || v.section == Section::output))
                continue;
            const bool is_by_value = v.section == Section::input && !is_by_address(*v.type);
            const std::string name = (v.section == Section::output                  ? "out_"
                                      : v.section == Section::input && !is_by_value ? "in_"
                                                                                    : "") +
                                     name_of(v);
            given +=
                is_by_value ? fmt::format(", *({}*)&{}", types.front(), name) : ", (void*)" + name;
            types.erase(types.begin());
        }
        if (found.result && is_by_address(*found.result->type)) given += ", (void*)returned";
        return given;
    }

    void write_dispatch(const Routine& wanted) {
        put("{} {{\nswitch (self->kind) {{", head(wanted, true));
        const Routine& root = wanted.owner ? *wanted.owner : wanted;
        for (const Routine* block : checked_.order) {
            if (!block->has_instances() || block->owner || block->pou->is_abstract) continue;
            if (!is_a(*block, root)) continue;
            const Routine* found = wanted.owner ? nearest(*block, wanted) : block;
            if (!found || !has_body(*found)) continue;
            const Routine& of = found->owner ? *found->owner : *found;
            put("case {}: twin_enter((({}*)self)->{} == twin_scan, {}, {});",
                number_of(block->type), c_type(*of.type), mark_of(*found), found->depth,
                main_.levels);
            const std::string call =
                fmt::format("{}(({}*)self{})", name_of(*found), c_type(*of.type),
                            wanted.owner ? passed_on(wanted, *found) : "");
            if (wanted.result && !is_by_address(*wanted.result->type))
                put("{{ {} r = {}; return *({}*)&r; }}", c_type(*found->result->type), call,
                    c_type(*wanted.result->type));
            else
                put("{}; return;", call);
        }
        put("}}\n__builtin_trap();\n}}");
    }

    void write(const Routine& routine) {
        routine_ = &routine;
        const bool is_block = routine.has_instances();
        const Variable* result = routine.result;
        put("{} {{", head(routine, false));
        if (has_instance(routine))
            put("const i64 ran = self->{0};\nself->{0} = twin_scan;", mark_of(routine));
        put("++twin_calls;");
        for (const Variable& v : routine.variables)
            if (!is_block && v.section == Section::input && v.space != Space::constant &&
                is_by_address(*v.type))
                put("{0} {1} = *in_{1};", c_type(*v.type), name_of(v));
        for (const Variable& v : routine.variables) {
            if (v.space != Space::frame || (is_block ? v.section != Section::temp : is_input(v)))
                continue;
            if (is_block)
                put("const {0} kept_{1} = self->{1};", c_type(*v.type), name_of(v));
            else
                put("{} {};", c_type(*v.type), name_of(v));
            begin(v, (is_block ? "self->" : "") + name_of(v));
        }
        write(routine.body);
        put("leave:;\n--twin_calls;");
        for (const Variable& v : routine.variables)
            if (!is_block && v.section == Section::output && v.space == Space::frame)
                put("*out_{0} = {0};", name_of(v));
        for (const Variable& v : routine.variables)
            if (is_eno(v)) put("twin_eno = {}{};", is_block ? "self->" : "", name_of(v));
        if (has_instance(routine)) end_on_instance(routine);
        if (result)
            put("{} {};", is_by_address(*result->type) ? "*returned =" : "return",
                name_of(*result));
        put("}}");
        routine_ = nullptr;
    }

    /// What the outer call of a body has is there again.
    void end_on_instance(const Routine& routine) {
        put("self->{} = ran;", mark_of(routine));
        for (const Variable& v : routine.variables)
            if (!routine.owner && v.space == Space::frame && v.section == Section::temp)
                put("if (ran == twin_scan) self->{0} = kept_{0};", name_of(v));
    }

    void write_ends() {
        put("static {} {}main;", c_type(*main_.type), prefix_);
        put("static void {}begin(void) {{", prefix_);
        put("{0}begin{1}(&{0}main);", prefix_, number_of(main_.type));
        for (std::size_t i = 0; i < checked_.globals.size(); ++i) {
            const Global& global = checked_.globals[i];
            if (is_image(i)) {
                begin_image();
                continue;
            }
            put("{0}begin{1}(&{0}g{2});", prefix_, number_of(global.type), i);
            for (const Statement* s : global.pou ? global.pou->body : Block())
                give(place(*s->target), *s->target->type, *s->value);
        }
        put("}}\nstatic i64 {}scan(const u64* in) {{", prefix_);
        int input = 0;
        for (const Variable& v : main_.variables) {
            if (v.section != Section::input || v.space != Space::frame) continue;
            const std::string to = fmt::format("{}main.{}", prefix_, name_of(v));
            if (v.type->is_real())
                put("{{ f64 x; memcpy(&x, in + {}, 8); {} = ({})x; }}", input, to, c_type(*v.type));
            else
                put("{} = ({})in[{}];", to, c_type(*v.type), input);
            ++input;
        }
        put("++twin_scan;\ntwin_calls = -1;\ni64 fault = setjmp(twin_end);\nif (fault == 0) "
            "{}(&{}main);\nreturn "
            "fault;\n}}",
            name_of(main_), prefix_);
        put("static u64* {}dump(u64* to) {{", prefix_);
        put("to = {0}dump{1}(&{0}main, to);", prefix_, number_of(main_.type));
        for (std::size_t i = 0; i < checked_.globals.size(); ++i)
            if (is_image(i))
                put("to = twin_put_bytes(to, {}image, {});", prefix_, checked_.image.bytes);
            else
                put("to = {0}dump{1}(&{0}g{2}, to);", prefix_, number_of(checked_.globals[i].type),
                    i);
        put("return to;\n}}");
    }

    void begin_image() {
        put("memset({0}image, 0, sizeof {0}image);", prefix_);
        for (const Variable* v : checked_.image.variables)
            if (v->initial && v->address.bits == 1)
                set_bit(*v, constant(*v->type, v->initial->constant));
            else if (v->initial)
                begin(*v, in_image(*v));
    }

    /// The byte of the process image where the variable begins.
    std::string byte_of(const Variable& v) const {
        return fmt::format("{}image[{}]", prefix_, checked_.image.bit_of(v.address) / 8);
    }

    std::string in_image(const Variable& v) {
        return fmt::format("(*({}*)&{})", c_type(*v.type), byte_of(v));
    }

    void set_bit(const Variable& v, const std::string& bit) {
        put("{0} = (u8)(({0} & ~(1u << {1})) | ({2} & 1u) << {1});", byte_of(v),
            static_cast<int>(v.address.bit), bit);
    }

    static bool is_image_bit(const Expression& e) {
        return e.kind == E::name && e.variable && e.variable->space == Space::image &&
               e.variable->address.bits == 1;
    }

    // Statements.

    void write(const Block& block) {
        for (const Statement* s : block) {
            put("{{");
            write(*s);
            put("}}");
        }
    }

    void write(const Statement& s) {
        at(s.place);
        switch (s.kind) {
            case S::assign:
                return write_assignment(s);
            case S::call:
                call(*s.value);
                return;
            case S::if_:
                return write_if(s);
            case S::case_:
                return write_case(s);
            case S::for_:
                return write_for(s);
            case S::while_:
            case S::repeat:
                return write_loop(s);
            case S::try_:
                return write_try(s);
            case S::exit:
                return put("goto exit{};", loops_.back());
            case S::continue_:
                return put("goto next{};", loops_.back());
            case S::return_:
                return put("goto leave;");
            case S::label:
                return put("label_{}: ;", s.value->token.text);
            case S::goto_:
                return put("goto label_{};", s.value->token.text);
            case S::action:
            case S::sequence:
                return write(s.body);
        }
    }

    void at(Place place) { line_ = place.mark().line; }

    void write_assignment(const Statement& s) {
        const Expression& target = *s.target;
        if (target.type->is_reference()) {
            const std::string to = value(*s.value);
            return put("{} = {};", place(target), to);
        }
        if (is_image_bit(target)) return set_bit(*target.variable, value(*s.value));
        if (target.kind == E::bit) {
            const std::string bits = value(*s.value), whole = place(*target.operands[0]);
            const auto [first, mask] = bits_of(target);
            return put("{0} = ({1})(((u64){0} & ~({2} << {3})) | ((u64){4} & {2}) << {3});", whole,
                       c_type(*target.operands[0]->type), mask, first, bits);
        }
        if (target.is_character()) {
            const std::string c = value(*s.value), in = "&" + place(*target.operands[0]);
            return put("twin_set_character({}, {}, {}, {}, {});", in,
                       value(*target.arguments[0].value), c, target.operands[0]->type->length,
                       line_);
        }
        const Expression& root = root_of(target);
        if (root.kind != E::deref) return assign(place(target), *target.type, *s.value);
        const std::string type = c_type(*root.type), from = pointer(*root.operands[0]);
        known_.emplace_back(&root, fmt::format("(*({}*){}.at)", type, from));
        const std::string to = place(target);
        known_.pop_back();
        assign(to, *target.type, *s.value,
               fmt::format("twin_reach({}, sizeof({}), {});", from, type, line_));
    }

    static std::pair<int, std::string> bits_of(const Expression& e) {
        const auto [first, count] = e.bits;
        return {first, fmt::format("{:#x}ull", count >= 64 ? ~0ULL : (1ULL << count) - 1)};
    }

    /// What is `first` comes between the value and where it goes to: a pointer is reached there.
    void assign(const std::string& to, const Type& type, const Expression& from,
                const std::string& first = "") {
        const bool is_text = type.kind == Kind::text;
        const std::string given = type.is_scalar() ? made(c_type(type), value(from))
                                  : is_text        ? text(from)
                                                   : aggregate(from);
        put("{}", first);
        if (type.is_scalar()) return put("{} = {};", to, given);
        if (is_text) return put("twin_set(&{}, {}, {});", to, type.length, given);
        put("memmove(&{0}, &{1}, sizeof {0});", to, given);
    }

    void write_if(const Statement& s) {
        std::size_t ends = 0;
        for (const Branch& branch : s.branches) {
            at(branch.condition->place);
            put("if ({}) {{", value(*branch.condition));
            write(branch.body);
            put("}} else {{");
            ++ends;
        }
        write(s.body);
        for (; ends > 0; --ends) put("}}");
    }

    void write_case(const Statement& s) {
        const std::string selector = value(*s.value);
        const Type& type = *s.value->type;
        for (const Branch& branch : s.branches) {
            std::string condition;
            for (const auto& [from, to] : branch.labels) {
                const std::string lower = constant(type, from->constant);
                condition += condition.empty() ? "" : " || ";
                condition += to ? fmt::format("({0} >= {1} && {0} <= {2})", selector, lower,
                                              constant(type, to->constant))
                                : fmt::format("{} == {}", selector, lower);
            }
            put("if ({}) {{", condition);
            write(branch.body);
            put("}} else");
        }
        put("{{");
        write(s.body);
        put("}}");
    }

    void write_for(const Statement& s) {
        const Type& type = s.target->type->plain();
        const std::string counter = place(*s.target);
        put("{} = {};", counter, value(*s.value));
        const std::string limit = value(*s.limit);
        const std::string step = s.step ? value(*s.step) : std::string("1");
        const int loop = ++labels_;
        loops_.push_back(loop);
        put("for (;;) {{\nif ((i128){0} >= 0 ? {1} > {2} : {1} < {2}) break;", step, counter,
            limit);
        write(s.body);
        at(s.place);
        put("next{}:;\nconst i128 sum = (i128){} + {};", loop, counter, step);
        if (const Type& given = *s.target->type; given.is_subrange) {
            put("if ((i128){0} >= 0 ? sum > {1} : sum < {1}) break;", step, limit);
            check_range("sum", given.lower, given.upper);
        }
        put("{} = ({})sum;", counter, c_type(type));
        put("if (sum != (i128){}) break;\n}}\nexit{}:;", counter, loop);
        loops_.pop_back();
    }

    void write_loop(const Statement& s) {
        const int loop = ++labels_;
        loops_.push_back(loop);
        put("for (;;) {{");
        const bool is_while = s.kind == S::while_;
        at(s.value->place);
        if (is_while) put("if (!{}) break;", value(*s.value));
        write(s.body);
        put("next{}:;", loop);
        at(s.value->place);
        if (!is_while) put("if ({}) break;", value(*s.value));
        put("}}\nexit{}:;", loop);
        loops_.pop_back();
    }

    void write_try(const Statement& s) {
        const std::string kept = new_name(), fault = new_name();
        put("{{ jmp_buf {0}; memcpy({0}, twin_end, sizeof {0});", kept);
        put("const i64 calls_{0} = twin_calls;\n"
            "const int {0} = setjmp(twin_end) / 1000000;\nif (!{0}) {{",
            fault);
        write(s.body);
        put("memcpy(twin_end, {0}, sizeof {0});\n}} else {{", kept);
        put("memcpy(twin_end, {0}, sizeof {0});\ntwin_calls = calls_{1};", kept, fault);
        if (s.target) put("{} = twin_exception({});", place(*s.target), fault);
        write(s.branches[0].body);
        put("}}");
        write(s.branches[1].body);
        put("}}");
    }

    // Values. Each is computed where it stands, from left to right, into a C variable of its own.

    std::string new_name() { return fmt::format("t{}", ++temporaries_); }

    std::string made(const std::string& type, const std::string& value) {
        const std::string name = new_name();
        put("{} {} = {};", type, name, value);
        return name;
    }

    std::string made(const Type& type, const std::string& value) {
        return made(c_type(type), value);
    }

    std::string fault(std::string_view name) {
        return fmt::format("twin_fault({}, {})", name, line_);
    }

    std::string value(const Expression& e) {
        if (e.type && e.type->is_reference()) return pointer(e);
        if (e.type && e.type->kind == Kind::interface) return instance(e);
        if (is_image_bit(e))
            return made(*e.type, fmt::format("{} >> {} & 1", byte_of(*e.variable),
                                             static_cast<int>(e.variable->address.bit)));
        switch (e.kind) {
            case E::constant:
                return constant(*e.type, e.constant);
            case E::name:
            case E::member:
            case E::deref:
            case E::index:
                return e.is_character() ? character(e) : made(*e.type, place(e));
            case E::bit: {
                const auto [first, mask] = bits_of(e);
                return made(*e.type,
                            fmt::format("(u64){} >> {} & {}", value(*e.operands[0]), first, mask));
            }
            case E::call:
                return e.routine ? call(e) : standard(e);
            case E::unary:
                return unary(e);
            case E::binary:
                return binary(e);
            default:
                return converted(e);
        }
    }

    std::string character(const Expression& e) {
        const std::string in = text(*e.operands[0]);
        return made(*e.type,
                    fmt::format("twin_character({}, {}, {}, {})", in, e.operands[0]->type->length,
                                value(*e.arguments[0].value), line_));
    }

    /// The bytes of the variable that it is in, and one of them.
    std::string pointer(const Expression& e) {
        switch (e.kind) {
            case E::constant:
                return made("pointer", "{0, 0, 0}");
            case E::refer:
                return referred(*e.operands[0]);
            case E::converted:
                return e.operands[0]->type->is_reference() ? pointer(*e.operands[0])
                                                           : referred(*e.operands[0]);
            case E::binary: {
                const std::string name = made("pointer", pointer(*e.operands[0]));
                const std::string by = value(*e.operands[1]);
                put("if ({0}.lo) {0}.at {1}= {2};", name, e.op == Word::minus ? "-" : "+", by);
                return name;
            }
            case E::call:
                return call(e);
            default:
                return made("pointer", place(e));
        }
    }

    std::string referred(const Expression& e) {
        const Expression& root = root_of(e);
        std::string first, lo, hi;
        if (root.kind == E::deref) {
            const std::string of = pointer(*root.operands[0]);
            first = of + ".at", lo = of + ".lo", hi = of + ".hi";
        } else {
            lo = first = made("u8*", "(u8*)&" + place(root));
            hi = fmt::format("{} + sizeof({})", lo, c_type(*root.type));
        }
        known_.emplace_back(&root, fmt::format("(*({}*){})", c_type(*root.type), first));
        const std::string at = place(e);
        known_.pop_back();
        return made("pointer", fmt::format("{{(u8*)&{}, {}, {}}}", at, lo, hi));
    }

    std::string reached(const Expression& pointer_to) {
        const std::string from = pointer(pointer_to), type = c_type(*pointer_to.type->element);
        return fmt::format(
            "(*({0}*){1})", type,
            made("u8*", fmt::format("twin_reach({}, sizeof({}), {})", from, type, line_)));
    }

    std::string instance(const Expression& e) {
        if (e.kind == E::constant) return "(block*)0";
        if (e.kind == E::call) return call(e);
        if (e.kind != E::converted) return made("block*", place(e));
        const Expression& of = *e.operands[0];
        return of.type->kind == Kind::interface ? instance(of)
                                                : made("block*", "(block*)&" + place(of));
    }

    std::string place(const Expression& e) {
        for (const auto& [known, place] : known_)
            if (known == &e) return place;
        if (e.kind == E::index) return element(e);
        if (e.kind == E::deref) return reached(*e.operands[0]);
        if (e.kind == E::self) return fmt::format("(*({}*)self)", c_type(*e.type));
        const Variable& v = *e.variable;
        if (e.kind == E::member) {
            const std::string of = place(*e.operands[0]);
            const std::string name = of + "." + name_of(v);
            return v.space == Space::reference ? reference(name) : name;
        }
        if (v.space == Space::image) return in_image(v);
        if (v.space == Space::global) {
            if (const auto it = global_parts_.find(&v); it != global_parts_.end())
                return fmt::format("{}g{}.{}", prefix_, it->second, name_of(v));
            return fmt::format("{}g{}", prefix_, v.global);
        }
        if (!routine_) return fmt::format("{}g{}.{}", prefix_, global_parts_.at(&v), name_of(v));
        const bool own = routine_->has_instances() || v.of != routine_->pou;
        const std::string name = (own ? "self->" : "") + name_of(v);
        if (v.space != Space::reference) return name;
        return routine_->owner && own ? reference(name) : "(*" + name + ")";
    }

    /// What a VAR_IN_OUT means that no call may have given yet.
    std::string reference(const std::string& name) {
        put("if (!{}) {};", name, fault("no_reference"));
        return "(*" + name + ")";
    }

    std::string element(const Expression& e) {
        std::string at = place(*e.operands[0]);
        const Type* type = e.operands[0]->type;
        for (const Argument& argument : e.arguments) {
            const std::string index = value(*argument.value);
            if (argument.value->kind != E::constant)
                put("if ((i128){0} < {1} || (i128){0} > {2}) {3};", index, type->lower, type->upper,
                    fault("array_bounds"));
            at += fmt::format(".e[(i64){} - ({})]", index, type->lower);
            type = type->element;
        }
        return at;
    }

    std::string aggregate(const Expression& e) {
        if (e.kind != E::call) return place(e);
        return e.routine ? call(e) : "(*" + standard(e) + ")";
    }

    /// What a function takes: of an array or a structure its address.
    std::string argument(const Expression& e) {
        if (e.type->kind == Kind::text) return text(e);
        return e.type->is_scalar() || e.type->is_reference() ? value(e) : "&" + aggregate(e);
    }

    std::string unary(const Expression& e) {
        const std::string a = value(*e.operands[0]);
        const Type& type = *e.type;
        if (e.op == Word::plus) return a;
        if (e.op == Word::not_) return made(type, (type.kind == Kind::boolean ? "!" : "~") + a);
        return made(type, type.is_real() ? "-" + a : "0 - (u64)" + a);
    }

    static bool is_text(const Expression& e) { return e.type->kind == Kind::text; }

    std::string binary(const Expression& e) {
        const Type& type = *e.type;
        if (e.op == Word::and_then_ || e.op == Word::or_else_) return lazy(e);
        const std::string op = c_operator(e.op);
        if (is_text(*e.operands[0])) {
            const std::string a = text(*e.operands[0]), b = text(*e.operands[1]);
            return made(type, fmt::format("twin_compare({}, {}) {} 0", a, b, op));
        }
        const std::string a = value(*e.operands[0]), b = value(*e.operands[1]);
        if (e.operands[0]->type->is_reference()) {
            if (e.op == Word::minus) return made(type, fmt::format("{}.at - {}.at", a, b));
            return made(type,
                        fmt::format("({0}.at == {1}.at && {0}.lo == {1}.lo) {2} 1", a, b, op));
        }
        if (e.op >= Word::less && e.op <= Word::unequal)
            return made(type, fmt::format("{} {} {}", a, op, b));
        if (type.kind == Kind::time) return of_times(e, a, b);
        if (e.op == Word::power)
            return made(type, fmt::format("Sleef_cinz_powd1_u10purec({}, {})", a, b));
        if (type.is_real()) return made(type, fmt::format("{} {} {}", a, op, b));
        return of_integers(e.op, type, a, b);
    }

    std::string of_integers(Word word, const Type& type, const std::string& a,
                            const std::string& b) {
        const std::string op = c_operator(word);
        if (word != Word::divided && word != Word::mod_)
            return made(type, fmt::format("(u64){} {} (u64){}", a, op, b));
        put("if ({} == 0) {};", b, fault("division_by_zero"));
        const std::string wide = type.is_signed || type.kind == Kind::time ? "i128" : "u64";
        return made(type, fmt::format("({0}){1} {2} ({0}){3}", wide, a, op, b));
    }

    std::string of_times(const Expression& e, const std::string& a, const std::string& b) {
        if (!e.operands[0]->type->is_real() && !e.operands[1]->type->is_real())
            return of_integers(e.op, *e.type, a, b);
        return rounded(*e.type, fmt::format("(f64){} {} (f64){}", a, c_operator(e.op), b));
    }

    static std::string c_operator(Word op) {
        switch (op) {
            case Word::less:
                return "<";
            case Word::less_or_equal:
                return "<=";
            case Word::greater:
                return ">";
            case Word::greater_or_equal:
                return ">=";
            case Word::equal:
                return "==";
            case Word::unequal:
                return "!=";
            case Word::and_:
                return "&";
            case Word::or_:
                return "|";
            case Word::xor_:
                return "^";
            case Word::plus:
                return "+";
            case Word::minus:
                return "-";
            case Word::times:
                return "*";
            case Word::divided:
                return "/";
            default:
                return "%";
        }
    }

    std::string lazy(const Expression& e) {
        const std::string name = new_name();
        put("u8 {} = {};", name, value(*e.operands[0]));
        put("if ({}{}) {{", e.op == Word::and_then_ ? "" : "!", name);
        put("{} = {};\n}}", name, value(*e.operands[1]));
        return name;
    }

    // Conversions.

    /// A real number to the nearest whole one, the even one of two.
    std::string rounded(const Type& type, const std::string& real) {
        const std::string r = made("f64", fmt::format("rint({})", real));
        const int bits = type.bits - (type.is_signed ? 1 : 0);
        put("if (!({0} >= {1} && {0} < {2})) {3};", r,
            real_constant(type.is_signed ? -std::ldexp(1, bits) : 0),
            real_constant(std::ldexp(1, bits)), fault("out_of_range"));
        return made(type, r);
    }

    std::string converted(const Expression& e) {
        const Expression& operand = *e.operands[0];
        if (is_text(operand)) {
            const std::string from = text(operand);
            if (e.type->is_character)
                return made(*e.type, fmt::format("twin_character({}, 1, 1, 0)", from));
            return made(*e.type, fmt::format("twin_read_{}({}, {})",
                                             e.type->is_real() ? "real" : "integer", from, line_));
        }
        if (e.conversion.is_bcd)
            return made(*e.type, fmt::format("twin_to_bcd({}, {}, {})", value(operand),
                                             e.type->bits / 4, line_));
        return convert(value(operand), *operand.type, *e.type, e.conversion.truncates);
    }

    void check_range(const std::string& x, std::int64_t least, std::int64_t most) {
        put("if ((i128){0} < {1} || (i128){0} > {2}) {3};", x, least, most, fault("out_of_range"));
    }

    std::string convert(const std::string& x, const Type& given_from, const Type& to,
                        bool truncates = false) {
        const Type& from = given_from.plain();
        if (to.is_subrange) {
            const std::string whole = convert(x, from, to.plain(), truncates);
            check_range(whole, to.lower, to.upper);
            return whole;
        }
        if (&from == &to) return x;
        if (from.kind == Kind::enumeration && !from.counted) return convert(x, lint_type, to);
        if (to.kind == Kind::enumeration) {
            const std::string whole = from.is_real() ? rounded(lint_type, x) : x;
            check_range(whole, 0, static_cast<std::int64_t>(to.values.size()) - 1);
            return made(to, whole);
        }
        if (from.is_time() || to.is_time()) return convert_time(x, from, to);
        if (to.kind == Kind::boolean) return made(to, x + " != 0");
        const bool same_bits = from.bits == to.bits && (from.is_bits() || to.is_bits());
        if (from.is_real() != to.is_real() && same_bits) {
            const std::string name = new_name();
            put("{0} {1}; memcpy(&{1}, &({2}){{{3}}}, sizeof {1});", c_type(to), name, c_type(from),
                x);
            return name;
        }
        if (from.is_real() && !to.is_real()) return rounded(to, truncates ? "trunc(" + x + ")" : x);
        return made(to, x);
    }

    /// In ns as an integer of 64 bits, and LTIME and its like as any number. Else TIME and TOD in
    /// ms, DATE and DT in s, DATE in 16 bits in days since 1990.
    std::string convert_time(const std::string& x, const Type& from, const Type& to) {
        if (from.is_time() && to.is_time()) {
            if (from.kind != Kind::moment || to.kind == Kind::moment) return x;
            const std::string clock = made(to, fmt::format("twin_clock({})", x));
            return to.kind == Kind::clock ? clock : made(to, x + " - " + clock);
        }
        if (to.kind == Kind::boolean) return made(to, x + " != 0");
        const Type &time = from.is_time() ? from : to, &number = from.is_time() ? to : from;
        const bool is_date = time.kind == Kind::date, in_days = is_date && number.bits == 16;
        const char* const unit = in_days                                ? "86400000000000"
                                 : time.counts_ns                       ? "1"
                                 : is_date || time.kind == Kind::moment ? "1000000000"
                                                                        : "1000000";
        if (from.is_real()) return rounded(to, fmt::format("(f64){} * {}.0", x, unit));
        if (to.is_real()) return made(to, fmt::format("(f64){} / {}.0", x, unit));
        if (number.bits == 64) return made(to, x);
        const int start = in_days ? 7305 : 0;
        if (to.is_time()) return made(to, fmt::format("((i64){} + {}) * {}", x, start, unit));
        return made(to, fmt::format("({} - {} * {}) / {}", x, start, unit, unit));
    }

    // Texts: the address of one.

    std::string new_text() {
        const std::string name = new_name();
        put("result {};", name);
        return name;
    }

    std::string text(const Expression& e) {
        if (e.kind == E::constant) {
            const std::string name = new_name();
            const std::size_t size = e.constant.text.size();
            put("struct {{ i64 length; char c[{}]; }} {};", size + 1, name);
            put("twin_literal(&{}, {}, {}, {});", name, size, quoted(e.constant.text), size);
            return "&" + name;
        }
        if (e.kind == E::call) return e.routine ? "&" + call(e) : text_function(e);
        if (e.kind != E::converted)
            return "&" + (e.type->is_open ? place(e) : made(*e.type, place(e)));
        const Type& from = *e.operands[0]->type;
        std::string number = value(*e.operands[0]);
        if (from.kind == Kind::enumeration) number = convert(number, from, lint_type);
        const std::string name = new_text();
        if (from.is_character) {
            put("twin_literal(&{0}, 254, (char[]){{{1}}}, {1} != 0);", name, number);
            return "&" + name;
        }
        const bool is_unsigned = from.is_unsigned_64();
        put("twin_{}(&{}, {});",
            from.is_real() ? (from.bits == 32 ? "single" : "real")
            : is_unsigned  ? "unsigned"
                           : "signed",
            name, number);
        return "&" + name;
    }

    std::string text_function(const Expression& e) {
        const StandardFunction& f = *e.standard;
        if (chooses(f)) return chosen_alone(e);
        std::vector<std::string> a;
        for (const Argument& argument : e.arguments) a.push_back(this->argument(*argument.value));
        std::string made = new_text();
        if (f.name == "CONCAT") {
            put("twin_set(&{}, 254, {});", made, a[0]);
            for (std::size_t i = 1; i < a.size(); ++i) {
                const std::string longer = new_text();
                put("twin_concat(&{}, &{}, {});", longer, made, a[i]);
                made = longer;
            }
        } else if (f.name == "LEFT") {
            put("twin_mid(&{}, {}, 1, {});", made, a[0], a[1]);
        } else if (f.name == "RIGHT") {
            const std::string length =
                this->made("i64", fmt::format("((const text*){})->length", a[0]));
            put("if ({1} > {3}) twin_set(&{0}, 254, {2}); else twin_mid(&{0}, {2}, {3} - {1} + 1, "
                "{1});",
                made, a[1], a[0], length);
        } else if (f.name == "MID") {
            put("twin_mid(&{}, {}, {}, {});", made, a[0], a[2], a[1]);
        } else if (f.name == "DELETE") {
            put("twin_replace(&{}, {}, 0, {}, {});", made, a[0], a[2], a[1]);
        } else if (f.name == "INSERT") {
            put("twin_replace(&{}, {}, {}, (i64){} + 1, 0);", made, a[0], a[1], a[2]);
        } else if (f.name == "REPLACE") {
            put("twin_replace(&{}, {}, {}, {}, {});", made, a[0], a[1], a[3], a[2]);
        } else {
            return one_of(*e.type, f, a);
        }
        return "&" + made;
    }

    // Calls.

    std::string call(const Expression& e) {
        at(e.place);
        const Expression& callee = *e.operands[0];
        const bool is_instance = callee.type && callee.type->is_instance();
        if (is_instance && !(e.routine && e.routine->owner)) return call_instance(e);
        if (!e.routine) return standard(e);
        return call_routine(e);
    }

    std::string call_routine(const Expression& e) {
        const Routine& routine = *e.routine;
        std::string given;
        const auto add = [&](const std::string& text) {
            given += (given.empty() ? "" : ", ") + text;
        };
        if (routine.owner) {
            const Expression* of =
                e.operands[0]->kind == E::member ? e.operands[0]->operands[0] : nullptr;
            const std::string type = e.is_dispatched ? "block" : c_type(*routine.owner->type);
            const bool through = of && of->type->kind == Kind::interface;
            const std::string self = through ? instance(*of) : of ? "&" + place(*of) : "self";
            add(made(type + "*", fmt::format("({}*){}", type, self)));
            if (through) put("if (!{}) {};", given, fault("no_reference"));
        }
        if (e.is_dispatched) dispatched_.insert(&routine);
        const std::string callee = e.is_dispatched ? dispatch_of(routine) : name_of(routine);
        std::unordered_map<const Variable*, std::string> values;
        for (const Argument& argument : e.arguments)
            if (is_input(*argument.variable)) values[argument.variable] = argument_of(argument);
        for (const Variable& v : routine.variables) {
            if (v.space == Space::constant || v.section == Section::result) continue;
            const bool is_address = v.section == Section::input && is_by_address(*v.type);
            if (is_input(v) && values.contains(&v)) add((is_address ? "&" : "") + values[&v]);
            if (v.section != Section::output &&
                (v.section != Section::input || values.contains(&v)))
                continue;
            const std::string name = new_name();
            put("{} {};", c_type(*v.type), name);
            if (v.section == Section::input) begin(v, name);
            add((v.section == Section::output || is_address ? "&" : "") + name);
            values[&v] = name;
        }
        const std::string name = new_name();
        if (e.is_dispatched) put("twin_line = {};", line_);
        if (routine.result && is_by_address(*routine.result->type)) {
            put("{} {};", c_type(*routine.result->type), name);
            add("&" + name);
            put("{}({});", callee, given);
        } else if (routine.result)
            put("{} {} = {}({});", c_type(*routine.result->type), name, callee, given);
        else
            put("{}({});", callee, given);
        for (const Argument& argument : e.arguments)
            if (is_eno(*argument.variable))
                take("twin_eno", argument);
            else if (argument.variable->section == Section::output)
                take(values[argument.variable], argument);
        return name;
    }

    /// A value, or the address of what is given as VAR_IN_OUT.
    std::string argument_of(const Argument& argument) {
        const Variable& v = *argument.variable;
        const std::string type = c_type(*v.type);
        if (v.section == Section::in_out)
            return made(type + "*", fmt::format("({}*)&{}", type, place(*argument.value)));
        if (!is_by_address(*v.type)) return value(*argument.value);
        const std::string name = new_name();
        put("{} {};", type, name);
        assign(name, *v.type, *argument.value);
        return name;
    }

    void take(const std::string& from, const Argument& argument) {
        const Type &given = *argument.variable->type, &wanted = *argument.value->type;
        const std::string to = place(*argument.value);
        if (given.is_scalar())
            put("{} = {};", to, convert(made(given, from), given, wanted));
        else
            put("memmove(&{0}, &{1}, sizeof {0});", to, from);
    }

    std::string call_instance(const Expression& e) {
        const Type& type = *e.operands[0]->type;
        const std::string self = made(c_type(type) + "*", "&" + place(*e.operands[0]));
        const bool at_once =
            type.kind == Kind::standard || std::ranges::none_of(e.arguments, [](const Argument& a) {
                return is_input(*a.variable) && has_call(*a.value);
            });
        std::vector<std::pair<const Variable*, std::string>> later;
        for (const Argument& argument : e.arguments) {
            const Variable& v = *argument.variable;
            if (!is_input(v)) continue;
            if (v.section == Section::in_out || !at_once)
                later.emplace_back(&v, argument_of(argument));
            else
                assign(self + "->" + name_of(v), *v.type, *argument.value);
        }
        for (const auto& [v, given] : later) put("{}->{} = {};", self, name_of(*v), given);
        if (e.is_dispatched) {
            dispatched_.insert(type.routine);
            put("twin_line = {};", line_);
            put("{}((block*){});", dispatch_of(*type.routine), self);
        } else if (type.kind == Kind::block)
            put("{}({});", name_of(*type.routine), self);
        else
            put("call_{}({});", small(type.standard->name), self);
        for (const Argument& argument : e.arguments)
            if (argument.variable->section == Section::output || is_eno(*argument.variable))
                take(self + "->" + name_of(*argument.variable), argument);
        return {};
    }

    // Standard functions.

    std::string standard(const Expression& e) {
        const StandardFunction& f = *e.standard;
        const Type& type = *e.type;
        if (f.result == Generic::text) return text_function(e);
        if (chooses(f)) return chosen_alone(e);
        std::vector<std::string> a;
        for (const Argument& argument : e.arguments) a.push_back(this->argument(*argument.value));
        const std::string_view name = f.name;
        if (name == "MEMCPY" || name == "MEMMOVE" || name == "MEMSET" || name == "MEMCMP")
            return made(
                type, fmt::format("twin_{}({}, {}, {}, {})", small(name), a[0], a[1], a[2], line_));
        if (name == "SQR") return made(type, fmt::format("{0} * {0}", a[0]));
        if (name == "FRAC") return made(type, fmt::format("{0} - trunc({0})", a[0]));
        if (name == "IS_VALID") return made(type, fmt::format("{0} - {0} == 0", a[0]));
        if (f.typing == Typing::real && f.result == Generic::any_int) {
            const std::string function = name == "ROUND"   ? "rint"
                                         : name == "TRUNC" ? "trunc"
                                                           : small(name);
            return rounded(type, fmt::format("{}({})", function, a[0]));
        }
        if (name == "NORM_X") {
            const std::string above = made(type, a[1] + " - " + a[0]),
                              range = made(type, a[2] + " - " + a[0]);
            return made(type, above + " / " + range);
        }
        if (name == "SCALE_X") {
            const std::string range = made(type, a[2] + " - " + a[0]);
            return made(type, fmt::format("{} + {}", made(type, a[1] + " * " + range), a[0]));
        }
        if (f.typing == Typing::real || f.typing == Typing::reals)
            return made(type, mathematical(name, a));
        if (name == "ABS" && type.is_real()) return made(type, fmt::format("fabs({})", a[0]));
        if (name == "ABS")
            return made(type, fmt::format("{0} < 0 ? 0 - (u64){0} : (u64){0}", a[0]));
        if (name == "LIMIT") return lesser(type, lesser(type, a[1], a[0], true), a[2], false);
        if (f.typing == Typing::places) return shifted(name, type, a[0], a[1]);
        if (name == "LEN") return made(type, fmt::format("((const text*){})->length", a[0]));
        if (name == "FIND") return made(type, fmt::format("twin_find({}, {})", a[0], a[1]));
        if (name == "SWAP")
            return made(type,
                        fmt::format("__builtin_bswap64((u64){}) >> {}", a[0], 64 - type.bits));
        if (name == "ENCO") return made(type, fmt::format("{0} ? __builtin_ctzll({0}) : 0", a[0]));
        if (name == "DECO")
            return made(type, fmt::format("1ull << ((u64){} & {})", a[0], type.bits - 1));
        if (f.typing == Typing::scan_time) return made(type, "twin_now");
        if (f.typing == Typing::statement) {
            const std::string type_of = c_type(*e.arguments[0].value->type);
            put("{{ {0}* t = {1}; const i64 pt = t->pt; memset(t, 0, sizeof *t); t->pt = pt; }}",
                type_of, a[0]);
            return {};
        }
        return one_of(type, f, a);
    }

    std::string lesser(const Type& type, const std::string& a, const std::string& b,
                       bool greatest) {
        return made(type, fmt::format("{0} {1} {2} ? {0} : {2}", b, greatest ? ">" : "<", a));
    }

    /// Writes MOVE, MIN and MAX.
    std::string one_of(const Type& type, const StandardFunction& f,
                       const std::vector<std::string>& a) {
        std::string so_far = a[0];
        for (std::size_t i = 1; i < a.size(); ++i)
            so_far = lesser(type, so_far, a[i], f.name == "MAX");
        return so_far;
    }

    static bool chooses(const StandardFunction& f) { return f.name == "SEL" || f.name == "MUX"; }

    /// SEL and MUX evaluate one of their arguments: of what is jumped over nothing is read.
    std::string chosen_alone(const Expression& e) {
        const Type& type = *e.type;
        const bool by_truth = e.standard->name == "SEL";
        const std::size_t last = e.arguments.size() - 1;
        const std::string c = c_type(type) + (type.is_scalar() || type.is_reference() ? "" : "*");
        const std::string number = value(*e.arguments[0].value), to = new_name(), end = new_name();
        put("{} {};", c, to);
        if (!by_truth && !same_name(e.arguments.back().name.text, "inelse"))
            put("if ((i128){0} < 0 || (i128){0} >= {1}) {2};", number, last, fault("array_bounds"));
        for (std::size_t i = 1; i <= last; ++i) {
            const std::string next = new_name();
            if (i < last && by_truth) put("if ({}) goto {};", number, next);
            if (i < last && !by_truth) put("if ({} != {}) goto {};", number, i - 1, next);
            const std::string one = argument(*e.arguments[i].value);
            put("{} = {}{};", to, type.is_reference() ? "" : "(" + c + ")", one);
            if (i < last) put("goto {};\n{}:;", end, next);
        }
        put("{}:;", end);
        return to;
    }

    std::string mathematical(std::string_view name, const std::vector<std::string>& a) {
        if (name == "SQRT") return fmt::format("sqrt({})", a[0]);
        if (name == "ATAN2") return fmt::format("Sleef_cinz_atan2d1_u10purec({}, {})", a[0], a[1]);
        return fmt::format("Sleef_cinz_{}d1_u10purec({})",
                           name == "LN"    ? "log"
                           : name == "LOG" ? "log10"
                                           : small(name),
                           a[0]);
    }

    std::string shifted(std::string_view name, const Type& type, const std::string& x,
                        const std::string& n) {
        if (name == "SHR" && type.is_signed)
            return made(type,
                        fmt::format("(i64){0} >> ((u64)(i64){1} < 63 ? (u64){1} : 63)", x, n));
        const std::string pattern = made(fmt::format("u{}", type.bits), x);
        const bool left = name == "SHL" || name == "ROL";
        if (name[0] == 'S')
            return made(type, fmt::format("(u64)(i64){2} >= {3} ? 0 : (u64){0} {1} {2}", pattern,
                                          left ? "<<" : ">>", n, type.bits));
        const std::string by = made("u64", fmt::format("(u64)(i64){} % {}", n, type.bits));
        return made(type,
                    fmt::format("{2} == 0 ? (u64){0} : (u64){0} {1} {2} | (u64){0} {3} ({4} - {2})",
                                pattern, left ? "<<" : ">>", by, left ? ">>" : "<<", type.bits));
    }

    const Checked& checked_;
    const Routine& main_;
    std::string prefix_, out_;
    std::unordered_map<const void*, int> numbers_;
    std::unordered_map<const Type*, bool> declared_;
    std::unordered_map<const Variable*, int> global_parts_;
    std::set<const Routine*, std::less<>> dispatched_;  ///< whose instance says what runs
    std::vector<std::pair<const Expression*, std::string>> known_;  ///< C of what was computed
    const Routine* routine_ = nullptr;
    int line_ = 0, temporaries_ = 0, labels_ = 0;
    std::vector<int> loops_;
};

void add_parts(std::vector<Part>& to, const std::string& name, const Type& type, std::size_t offset,
               int global) {
    if (type.is_reference() || type.kind == Kind::interface) return;
    if (type.kind == Kind::union_) {
        to.push_back({name, &type, global, offset, false, 8 * std::size_t{type.slots}});
    } else if (type.kind == Kind::array) {
        const Type& element = *type.element;
        const std::size_t step =
            8 * (element.kind == Kind::block ? element.routine->frame : element.slots);
        for (std::int64_t i = type.lower; i <= type.upper; ++i, offset += step)
            add_parts(to, fmt::format("{}[{}]", name, i), element, offset, global);
    } else if (type.kind == Kind::block) {
        for (const Variable* v : all_variables(*type.routine))
            if (v->space == Space::frame)
                add_parts(to, fmt::format("{}.{}", name, v->text), *v->type, offset + 8 * v->slot,
                          global);
    } else if (type.kind == Kind::structure || !type.members.empty()) {
        for (const Variable* v : type.members) {
            if (v->space == Space::image) continue;
            const std::size_t at = offset + (v->is_byte ? v->byte : 8 * v->slot);
            const std::string part = fmt::format("{}.{}", name, v->text);
            if (v->is_byte)
                to.push_back({part, v->type, global, at, true});
            else
                add_parts(to, part, *v->type, at, global);
        }
    } else {
        to.push_back({name, &type, global, offset});
    }
}

}  // namespace

std::string write_c(const Checked& checked, const Routine& main, int number) {
    return CWriter(checked, main, number).write();
}

std::vector<Part> parts_of(const Checked& checked, const Routine& main) {
    std::vector<Part> parts;
    add_parts(parts, "Main", *main.type, 0, -1);
    for (std::size_t i = 0; i < checked.globals.size(); ++i)
        if (checked.image.global == static_cast<int>(i))
            parts.push_back(
                {"%", checked.globals[i].type, static_cast<int>(i), 0, false, checked.image.bytes});
        else
            add_parts(parts, checked.globals[i].name, *checked.globals[i].type, 0,
                      static_cast<int>(i));
    return parts;
}

}  // namespace lineshaft::st
