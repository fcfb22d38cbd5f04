#include <unordered_set>

#include "runtime/st/check/declarations.hpp"

namespace lineshaft::st {

namespace {

void add_names(const Expression& e, std::vector<std::string_view>& to) {
    if (e.kind == E::name) to.push_back(e.token.text);
    for (const Expression* operand : e.operands)
        if (operand) add_names(*operand, to);
    for (const Argument& argument : e.arguments)
        if (argument.value) add_names(*argument.value, to);
}

/// B&R's constants may be made of those that stand further down in their list.
class ConstantsByNeed {
  public:
    explicit ConstantsByNeed(const DeclarationBlock& block) {
        for (Declaration* declared : block.declarations)
            named_.emplace(declared->name.text, declared);
        for (Declaration* declared : block.declarations) add(declared);
    }

    const std::vector<Declaration*>& sorted() const { return sorted_; }

  private:
    void add(Declaration* declared) {
        constexpr int deepest = 200;
        if (!seen_.insert(declared).second) return;
        std::vector<std::string_view> names;
        if (declared->initial && hops_ < deepest) add_names(*declared->initial, names);
        ++hops_;
        for (const std::string_view name : names)
            if (const auto found = named_.find(name); found != named_.end()) add(found->second);
        --hops_;
        sorted_.push_back(declared);
    }

    NameMap<Declaration*> named_;
    std::unordered_set<const Declaration*> seen_;
    std::vector<Declaration*> sorted_;
    int hops_ = 0;
};

}  // namespace

std::vector<Declaration*> in_order(const DeclarationBlock& block) {
    const bool may_be_later = block.constant && !block.declarations.empty() &&
                              block.declarations.front()->name.place.dialect().capitals_count;
    return may_be_later ? ConstantsByNeed(block).sorted() : block.declarations;
}

}  // namespace lineshaft::st
