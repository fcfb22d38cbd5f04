#include <fmt/format.h>

#include "runtime/program/program.hpp"
#include "runtime/program/program_form.hpp"
#include "runtime/program/program_parts.hpp"
#include "runtime/program/templates.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

void read_block(const Reader& read, const Node& name, const Node& body, Program& program) {
    if (!read.identifier(name, "a block")) return;
    if (name.text == "inputs" || name.text == "outputs")
        return read.fail(code::unusable_name, name,
                         fmt::format("a block cannot be called '{}'", name.text),
                         fmt::format("{0}.x names the program's own {0}", name.text));
    if (body.is_map() && body.find("use")) {  // of no template, which is told
        UsePlan use;
        read_form(use_form(), read, body, use, fmt::format("block '{}'", name.text));
        return;
    }
    BlockPlan& block = program.blocks.emplace_back();
    block.name = name;
    if (!read.expect_map(body, "a block")) return;
    read_form(block_form(), read, body, block, fmt::format("block '{}'", name.text), &name);
    for (const auto& port : body.entries)
        if (!block_form().find(port.first.text)) block.ports.push_back(port);
}

/// Only checked: the blocks are read where they are used.
struct TemplatePlan {};

}  // namespace

const Form& block_form() {
    static const Form form = form_of<BlockPlan>(
        {.name = "block",
         .what = "a block",
         .doc = "a function block; its parameters and inputs are keys beside these, see 'lineshaft "
                "blocks TYPE'. An "
                "input is a constant or a wire: b.q, inputs.x, NOT b.q, or previous(b.q) from the "
                "block itself or "
                "one behind it",
         .keys = {key<&BlockPlan::type>("type", a_value.as("a type"),
                                        "one of those that 'lineshaft blocks' lists")
                      .must("'lineshaft blocks' lists the types"),
                  key<&BlockPlan::task>("task", a_task, "scans it, in the order of the file")
                      .must("say which task scans it"),
                  key<&BlockPlan::cost>("cost", a_time, "adds to its task's execution time")
                      .by_default("0 s"),
                  key<&BlockPlan::called>(
                      "called", a_boolean,
                      "of a PROGRAM: others call it by its name, so its task does not scan it")
                      .by_default("false"),
                  key<&BlockPlan::initial>(
                      "initial", named("an output", a_value),
                      "outputs and what they are before the first scan: what previous() then "
                      "gives")},
         .others = key("PORT", a_value, "a parameter or an input of the type")});
    return form;
}

const Form& use_form() {
    static const Form form = form_of<UsePlan>(
        {.name = "use",
         .what = "a use",
         .doc = "the blocks of a template: left: {use: station} makes left_gate of its block gate",
         .keys = {
             key<&UsePlan::use>("use", a_value.as("the name of a template"), "a template").must(),
             key<&UsePlan::set>("set", named("a parameter", a_value),
                                "values of the template's parameters")}});
    return form;
}

const Form& template_form() {
    static const Form form = form_of<TemplatePlan>(
        {.name = "template",
         .what = "a template",
         .doc = "blocks that stand in the program as often as it is used; those of its own are "
                "named as they are written here",
         .keys = {key("parameters", named("a parameter", either({nothing, a_value})),
                      "names and values that a use may set, and must where there is none; $NAME "
                      "stands for the value"),
                  key("blocks",
                      named("a block", a_block(block_form)).filled("the template has no block"),
                      "in the order of their scan")
                      .must()}});
    return form;
}

void read_blocks(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) read_block(read, name, body, program);
}

}  // namespace lineshaft
