#include "runtime/st/library/retained.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "runtime/st/library/fields.hpp"
#include "runtime/st/library/shortened.hpp"
#include "runtime/st/types/parameters.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

bool is_given(const Variable& variable) {
    return variable.section == Section::input || variable.pin == Section::input;
}

/// It has memory of its own that is not the call's. `space`: of the variables that it is one of.
bool has_memory(const Variable& variable, Space space) {
    return variable.type && (variable.space == Space::frame || variable.space == space) &&
           !variable.constant && variable.section != Section::temp &&
           (variable.section != Section::in_out || is_kept_in_out(variable));
}

bool is_retained(const Variable& variable, bool is_within) {
    return variable.retention == Retention::unsaid ? is_within
                                                   : variable.retention == Retention::retain;
}

class Walk {
  public:
    explicit Walk(std::vector<RetainedVariable>& found) : found_(found) {}

    /// `is_outermost`: others give it its inputs.
    void visit_block(const Routine& block, std::size_t slot, const std::string& before,
                     bool is_within, bool is_outermost) {
        for (const Variable* variable : all_variables(block))
            if (!is_outermost || !is_given(*variable))
                visit(*variable, slot, before + of_base(block, *variable), is_within);
        for (const Routine* base = &block; base; base = base->base)
            for (const Routine* method : base->own_methods)
                for (const Variable& variable : method->variables)
                    if (variable.section == Section::kept)
                        visit(variable, slot, fmt::format("{}{}.", before, method->name),
                              is_within);
    }

    void visit(const Variable& variable, std::size_t slot, const std::string& before,
               bool is_within, Space space = Space::frame) {
        if (has_memory(variable, space))
            visit(*variable.type, slot + variable.slot, before + std::string(variable.text),
                  is_retained(variable, is_within));
    }

  private:
    void visit(const Type& type, std::size_t slot, const std::string& path, bool is_within) {
        if (!is_within && !declares(type)) return;
        switch (type.kind) {
            case Kind::array:
                if (is_long_list(type)) break;
                return visit_elements(type, slot, path + "[", is_within);
            case Kind::structure:
                for (const Variable* member : type.members)
                    visit(*member, slot, path + ".", is_within);
                return;
            case Kind::block:
                return visit_block(*type.routine, slot, path + ".", is_within, false);
            case Kind::handle:
            case Kind::interface:
            case Kind::reference:
                return;
            default:
                break;
        }
        found_.push_back({path, &type, 8 * slot, 8 * slots_of(type)});
    }

    /// It has so many numbers that it is kept as one.
    static bool is_long_list(const Type& array) {
        return array.innermost().is_scalar() && slots_of(array) > most_elements;
    }

    void visit_elements(const Type& array, std::size_t slot, const std::string& before,
                        bool is_within) {
        for (std::int64_t i = array.lower; i <= array.upper; ++i, slot += element_slots(array)) {
            const std::string path = before + std::to_string(i);
            if (array.has_inner)
                visit_elements(*array.element, slot, path + ",", is_within);
            else
                visit(*array.element, slot, path + "]", is_within);
        }
    }

    /// Some block that it has declares variables of its own to be RETAIN.
    bool declares(const Type& type) {
        if (type.kind == Kind::array) return declares(*type.element);
        if (type.kind != Kind::structure && type.kind != Kind::block) return false;
        const auto [it, is_new] = declares_.emplace(&type, false);
        if (!is_new) return it->second;
        const auto does = [&](const Variable& variable) {
            return variable.type &&
                   (variable.retention == Retention::retain || declares(*variable.type));
        };
        bool found = false;
        if (type.kind == Kind::structure) {
            found = std::ranges::any_of(type.members,
                                        [&](const auto* member) { return does(*member); });
        } else {
            for (const Variable* variable : all_variables(*type.routine)) found |= does(*variable);
            for (const Routine* block = type.routine; block; block = block->base)
                for (const Routine* method : block->own_methods)
                    for (const Variable& variable : method->variables)
                        found |= variable.section == Section::kept && does(variable);
        }
        return declares_[&type] = found;
    }

    std::vector<RetainedVariable>& found_;
    std::map<const Type*, bool> declares_;
};

}  // namespace

std::vector<RetainedVariable> retained(const BlockType& kind) {
    std::vector<RetainedVariable> found;
    const KindContext* context = context_of(kind);
    if (!context || context->run_test || !context->type) return found;
    Walk walk(found);
    const bool is_within = context->retention == Retention::retain;
    if (context->type->kind == Kind::block) {
        walk.visit_block(*context->type->routine, 0, {}, is_within, !kind.single);
        return found;
    }
    for (const Variable* member : context->type->members)
        walk.visit(*member, 0, {}, is_within, Space::global);
    return found;
}

}  // namespace lineshaft::st
