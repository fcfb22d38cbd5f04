#include <functional>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

using Part = std::function<Expression*()>;

/// What nobody gives: see FieldWriter of library/fields.
bool is_own(const Variable& variable) {
    const bool is_kept = variable.section == Section::local || variable.section == Section::output;
    return variable.type && is_kept && variable.space == Space::frame && !variable.constant;
}

/// Assigns blocks of the program, one to each reference, at the beginning of tests.
class Giving {
  public:
    explicit Giving(Checking& c) : c_(c) {}

    /// `shared`: the other tests give it the same.
    void give(Routine& test, Variable& variable, bool shared) {
        test_ = &test;
        like_.token = variable.name;
        like_.place = variable.name.place;
        std::string path = shared ? std::string() : fmt::format("{}.", test.pou->place.mark().line);
        path += variable.text;
        give(*variable.type, path, [&] { return make_use(c_, like_, variable); });
    }

  private:
    void give(const Type& type, const std::string& path, const Part& part) {
        if (type.kind == Kind::handle)
            return test_->call_begins.push_back(
                make_assignment(c_, like_.place, part(), make_use(c_, like_, object(type, path))));
        if (type.kind == Kind::array) return give_elements(type, path, part);
        const bool is_block = type.kind == Kind::block;
        if (!is_block && type.kind != Kind::structure) return;
        if (std::ranges::count(open_, &type) > 0) return;  // it is in itself, which is told
        open_.push_back(&type);
        for (const Variable* member : is_block ? all_variables(*type.routine) : type.members)
            if (!is_block || is_own(*member))
                give(*member->type, fmt::format("{}.{}", path, member->text),
                     [&] { return make_member(c_, part(), member->text); });
        open_.pop_back();
    }

    void give_elements(const Type& array, const std::string& path, const Part& part) {
        if (!has_handle(*array.element)) return;
        for (std::int64_t i = array.lower; i <= array.upper; ++i)
            give(*array.element, fmt::format("{}.{}", path, i),
                 [&] { return make_element(c_, part(), i); });
    }

    Variable& object(const Type& handle, const std::string& path) {
        Variable*& made = objects_[path];
        if (made) return *made;
        std::string name = "axis_";
        for (const char x : path) name += is_letter(x) || is_digit(x) ? x : '_';
        while (c_.globals.contains(name)) name += '_';
        made = &c_.make_variable(like_.token, c_.checked.names.emplace_back(name), &handle);
        declare_object(c_, *made);
        return *made;
    }

    Checking& c_;
    Routine* test_ = nullptr;
    Expression like_;
    std::vector<const Type*> open_;             ///< what is given something, the outermost first
    std::map<std::string, Variable*> objects_;  ///< by what has them
};

bool is_setup(const Routine& routine) {
    return routine.is_test() && routine.pou->name.word == Word::setup_;
}

}  // namespace

void give_axes_to_tests(Checking& c) {
    if (!c.has_tests || !c.out.empty()) return;
    std::vector<Variable*> globals;
    for (Variable& variable : c.checked.variables)
        if (variable.space == Space::global && variable.named < 0 && variable.type &&
            has_handle(*variable.type))
            globals.push_back(&variable);
    Giving giving(c);
    const bool has_setup = std::ranges::any_of(c.checked.routines, is_setup);
    for (Routine& test : c.checked.routines) {
        if (!test.is_test()) continue;
        const bool is_last = test.pou->name.word == Word::teardown_;
        const bool is_first = is_setup(test) || (!has_setup && !is_last);
        for (Variable* variable : globals)
            if (is_first) giving.give(test, *variable, true);
        for (Variable& variable : test.owner->variables)
            if (is_first && is_own(variable)) giving.give(test, variable, true);
        for (Variable& variable : test.variables)
            if (is_own(variable)) giving.give(test, variable, false);
    }
}

}  // namespace lineshaft::st
