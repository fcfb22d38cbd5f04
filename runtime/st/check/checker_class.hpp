#pragma once

#include <optional>
#include <string>
#include <unordered_set>

#include <fmt/format.h>

#include "runtime/st/check/checker.hpp"
#include "runtime/st/prelude/standard_source.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

struct StandardFunction;

/// The standard's name of a part of its function blocks that CODESYS calls otherwise: RESET is R.
std::string_view standard_name(const Type& type, std::string_view name);

bool is_constant(const Expression& expression);

/// The number of a constant.
double as_real(const Expression& constant);

bool is_scl(const Expression& expression);

/// What check() keeps while it works: declarations.cpp, expressions.cpp, calls.cpp, statements.cpp.
/// One class, though large: a type asks for a constant, that for an expression, and that for a call
/// and its types again, and all of them for the names and the block that is being checked.
class Checker {
  public:
    Checker(Tree& tree, const Catalog& standard, Diagnostics& out)
        : tree_(tree), standard_(standard), out_(out) {}

    Checked check();

  private:
    using Kind = Type::Kind;
    using Code = const char*;

    struct NamedType {
        const TypeDeclaration* declaration = nullptr;
        const Type* type = nullptr;
        bool visiting = false;
    };

    /// A value of an enumeration.
    struct NamedValue {
        const Type* type = nullptr;
        std::size_t index = 0;
        bool ambiguous = false;
    };

    /// What is declared beside the blocks.
    struct Names {
        NameMap<NamedType> types;
        NameMap<NamedValue> values;
        NameMap<Routine*> routines;
        NameMap<Place> places;
    };

    // declarations.cpp
    void collect_names();
    Type& global_variables();
    Variable* declare_global(const Declaration& declared, bool constant, bool retain);
    Variable* declare_early(std::string_view name);
    Variable* declare_object(Variable& variable);
    void declare_globals();
    void declare_routines();
    void declare(Routine& routine, const DeclarationBlock& block);
    void make_object(Variable& variable);
    void make_constant(Variable& variable);
    void declare_edge(Routine& routine, Variable& variable, const Token& edge);
    void declare_result(Routine& routine);
    Variable* add(std::deque<Variable>& to, const Declaration& declared, const Type* type);
    bool is_new_name(Token name, NameMap<Place>& names, bool is_test = false);
    void check_unit(Variable& variable, const Declaration& declared);
    void check_initial_values();
    void check_data_block(const Global& global);
    bool is_constant_place(const Expression& place) const;
    void check_initial(Expression*& value, const Type& type);
    void check_elements(Expression& list, const Type& array);
    void check_members(Expression& list, const Type& type);
    const Type* resolve(const TypeText& text);
    const Type* resolve_name(const Token& name);
    const Type* resolve_declared(NamedType& named);
    const Type* resolve_array(const TypeText& text);
    const Type* resolve_structure(const TypeText& text);
    const Type* resolve_enumeration(const TypeText& text);
    const Type* resolve_subrange(const TypeText& text);
    const Type* resolve_text(const TypeText& text);
    const Type* standard_type(std::string_view name);
    const Type* handle_type(std::string_view name);
    Type& make_type(Kind kind, std::string name);
    Routine& make_routine(Pou& pou, std::string name);
    void depend(const Type* type, Place place);
    void put_in_order();
    void visit(Routine& routine, std::vector<const Routine*>& path);
    void warn_of_unused();

    // expressions.cpp
    const Type* check(Expression& expression, const Type* expected = nullptr);
    const Type* check_constant(Expression& expression, const Type* expected);
    const Type* check_number(Expression& expression);
    const Type* check_time(Expression& expression);
    std::optional<Wide> read_dtl(const Expression& expression);
    const Type* check_dtl(Expression& expression);
    Expression* list_of_dtl(const Expression& literal, const Type& type);
    void become_moments(Expression& expression);
    const Type* check_dtl_arithmetic(Expression& expression);
    Expression* make_call(std::string_view function, Expression* argument);
    const Type* check_text(Expression& expression);
    const Type* check_name(Expression& expression, const Type* expected);
    const Type* use(Expression& expression, Variable& variable);
    const Type* use_object(Expression& expression, const Type& type);
    const Type* object_type(const Type& handle);
    bool is_object_of(const Expression& member);
    Routine* find_part(const Type& type, std::string_view name);
    const Type* check_part(Expression& member, Routine& part);
    const Type* unknown_name(Expression& expression);
    const Type* undeclared(const Token& name, Place place, const std::vector<std::string>& names);
    const Type* enumeration_of(const Expression& member);
    const Type* check_value(Expression& e, const Type& enumeration, const Token& name);
    const Type* check_member(Expression& expression);
    const Type* check_index(Expression& expression);
    const Type* check_bit(Expression& expression);
    const Type* check_unary(Expression& expression, const Type* expected);
    const Type* check_binary(Expression& expression, const Type* expected);
    void become_number(Expression*& e);
    void take_width(Expression*& e, const Type* expected);
    void check_masks(Expression& expression, const Type* expected);
    void reinterpret(Expression& expression, Kind from, const Type* expected = nullptr);
    const Type* check_logic(Expression& expression);
    void unite_texts(Expression*& a, Expression*& b);
    const Type* check_comparison(Expression& expression);
    const Type* check_arithmetic(Expression& expression, const Type* expected);
    const Type* check_time_arithmetic(Expression& expression);
    const Type* check_date_arithmetic(Expression& expression);
    const Type* check_power(Expression& expression, const Type* expected);
    const Type* unite(Expression& expression, const Type* expected = nullptr);
    bool rounds(const Expression& expression, const Type& to);
    const Type* check_typed(Expression& expression);
    void fold(Expression& expression);
    void fold_unary(Expression& expression, const Constant& value);
    void fold_binary(Expression& expression, const Constant& a, const Constant& b);
    void become(Expression& expression, const Type& type, Constant value);
    void become_boolean(Expression& expression, bool value);
    bool coerce_number(Expression*& expression, const Type& to);
    bool coerce(Expression*& expression, const Type& to);
    bool coerce_constant(Expression& expression, const Type& to);
    void convert(Expression*& expression, const Type& to);
    bool fold_conversion(Expression& expression, const Type& to);
    bool refuse_conversion(const Expression& expression, const Type& to);
    std::optional<Wide> check_whole(Expression*& expression, const Type& type);
    std::vector<std::string> visible_names() const;
    Variable* find_variable(const Token& token);

    // evaluated.cpp
    bool evaluate(Expression& expression);

    // calls.cpp
    void check_call(Statement& statement);
    const Type* check_call(Expression& call, bool as_statement, const Type* expected);
    const Type* check_routine_call(Expression& call, Routine& routine, bool as_statement);
    const Type* check_instance_call(Expression& call, const Type& type, bool as_statement);
    bool is_instance(const Token& name);
    bool is_in_test() const { return routine_ && routine_->is_test(); }
    void check_arguments(Expression& call, Routine& routine);
    void check_argument(Expression& call, Argument& argument, Variable& parameter);
    /// An input that a vendor adds to a block, which only a constant may set where `only` is given.
    void ignore(const Type& type, Argument& argument, std::optional<double> only);
    void check_standard_arguments(Expression& call, const Type& type);
    Variable* find_parameter(Argument& argument, Routine& routine, std::size_t position);
    bool check_count(const Expression& call, const StandardFunction& function);
    bool put_in_order(Expression& call, const StandardFunction& function);
    const Type* check_typed_function(Expression& call);
    const Type* check_standard_function(Expression& call, const Type* expected);
    std::optional<const Type*> check_conversion(Expression& call, std::string_view name);
    const Type* check_bcd(Expression& call, const Type* source, const Type& target, bool to_bcd);
    const Type* convert_result(Expression& call, const Type& from, const Type& to);
    const Type* check_scale(Expression& call, const Type* expected);
    const Type* standard_result(Expression& call, const Type* expected);
    const Type* check_bound(Expression& call);
    Expression* join(Expression& call, Word op);

    // test_statements.cpp
    const Type* check_test_statement(Expression& call, bool as_statement);
    bool check_test_arguments(Expression& call, const TestStatement& known);
    void check_single(Expression& call);
    void check_mocked(Expression& call);
    void become_text(Expression& expression);
    bool check_compared(Expression& call);
    bool check_distance(Expression& call);
    bool make_concrete(Expression*& expression, const Type& other);
    void check_mock_function(Expression& call);
    void add_mock(Routine& function);
    void leave_out(Expression& call, Variable& parameter);

    // rewritten.cpp
    bool rewrite(Statement& statement);
    void rewrite_enabled(Statement& statement, bool has_eno);
    void rewrite_bits(Statement& statement, bool scatters);
    Variable& eno_of(Routine& routine);
    void call_edges(Routine& routine);
    const Type* use_edge(Expression& name, Variable& edge);
    void check_special(Statement& statement);
    void check_timer(Expression& timer, std::string_view function);

    // statements.cpp
    void check_body(Routine& routine);
    void check(Block& block);
    void check(Statement& statement);
    void check_assignment(Statement& statement);
    void check_case(Statement& statement);
    void check_for(Statement& statement);
    void check_condition(Expression*& condition, std::string_view of);
    bool check_target(Expression& target, std::string_view how = "assigned");

    template <class... T>
    std::nullptr_t fail(Code code, Place place, std::string message, std::string help = {}) {
        out_.add(code, place.mark(), std::move(message), std::move(help));
        return nullptr;
    }

    /// What a name is. The standard's own sources see nothing of the user's; what they declare he
    /// sees where he has no such name.
    template <class T>
    T* look_up(NameMap<T> Names::*map, const Token& name) {
        if (!is_standards(name))
            if (const auto it = (users_.*map).find(name.text); it != (users_.*map).end())
                return &it->second;
        const auto it = (standards_.*map).find(name.text);
        return it == (standards_.*map).end() ? nullptr : &it->second;
    }
    Routine* find_routine(const Token& name) {
        Routine** const routine = look_up(&Names::routines, name);
        return routine ? *routine : nullptr;
    }
    Names& names_beside(const Token& name) { return is_standards(name) ? standards_ : users_; }
    static bool is_standards(const Token& name) {
        return name.place.file && is_standard_source(**name.place.file);
    }

    /// A type, block or function of the user's that was not understood.
    bool is_lost(const Token& name) const {
        const auto it = tree_.lost.find(name.text);
        return it != tree_.lost.end() && it->second && !is_standards(name);
    }

    static bool is_dtl(const Type& type) {
        return type.kind == Kind::structure && type.name == "DTL" &&
               std::ranges::any_of(type.members, is_standards, &Variable::name);
    }

    Expression* make(Expression::Kind kind, const Expression& like) {
        Expression& made = tree_.expressions.emplace_back();
        made.kind = kind;
        made.token = like.token;
        made.place = like.place;
        return &made;
    }

    Tree& tree_;
    const Catalog& standard_;
    Diagnostics& out_;
    Checked checked_;
    Names users_, standards_;
    NameMap<Variable*> globals_;
    NameMap<const Declaration*> constants_;  ///< of VAR_GLOBAL, until all globals are declared
    std::unordered_set<const Declaration*> begun_constants_;  ///< declared already, or being so
    int hops_ = 0;  ///< from constant to constant that is declared later
    NameMap<const Type*> standard_types_;
    bool has_tests_ = false;
    Type* mocks_ = nullptr;       ///< of the global that has what MOCK_FUNCTION says
    Routine* routine_ = nullptr;  ///< that is being checked
    int loops_ = 0;               ///< around the statement
    std::unordered_map<const Routine*, NameSet> undeclared_;  ///< names that were told
};

}  // namespace lineshaft::st
