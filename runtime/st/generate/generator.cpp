#include "runtime/st/generate/generator.hpp"

#include <algorithm>

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/statements.hpp"

namespace lineshaft::st {

namespace {

void begin(Writing& w, Routine& routine) {
    w.routine = &routine;
    if (routine.owner || routine.is_function())
        lay_out_call(w, routine);
    else
        lay_out(w, routine);
    w.landed = w.next();
    Routine* block = routine.owner ? routine.owner : &routine;
    w.image = routine.is_function() ? &w.function_images[&routine] : &w.images[block->type];
    w.temporaries = w.most_temporaries = w.windows = 0;
    w.unwritten.clear();
    w.constants.clear();
    w.constant_slots.clear();
    w.loops.clear();
    w.labels.clear();
    w.code.routines.push_back({.name = routine.name,
                               .entry = w.next(),
                               .depth = routine.depth,
                               .levels = block->levels,
                               .mark = routine.mark});
    const std::uint32_t first = routine.owner ? routine.first : routine.temps_begin;
    w.code.routines.back().variables = {first, routine.ring != 0 ? routine.variables_end : first};
    w.code.routines.back().holds_instance = routine.holds_instance;
    w.place = routine.pou->place;
    if (routine.mark != 0) w.put(Op::move, routine.mark, w.constant_slot(1));
    const bool in_function = routine.is_function();
    if (in_function || routine.temps_begin < routine.variables_end) {
        w.image_uses.push_back({w.next(), in_function ? nullptr : block->type, &routine});
        w.put(Op::initialise, routine.temps_begin, routine.temps_begin,
              routine.variables_end - routine.temps_begin);
    }
    if (routine.activation != 0) w.put(Op::number_call, routine.activation);
}

/// A block's frame grows by what its body and its methods need; `variables_end` is then behind it.
void finish(Writing& w, Routine& routine) {
    Routine& frame_of = routine.owner ? *routine.owner : routine;
    const bool is_function = routine.is_function();
    const std::uint32_t constants =
        is_function ? routine.variables_end : static_cast<std::uint32_t>(w.image->size());
    const auto temporaries = constants + static_cast<std::uint32_t>(w.constants.size());
    const std::uint32_t windows = temporaries + w.most_temporaries;
    w.image->insert(w.image->end(), w.constants.begin(), w.constants.end());
    CodeRoutine& code = w.code.routines.back();
    code.end = w.next();
    for (const auto& [bits, slot] : w.constant_slots)
        code.constants.push_back({constants + (slot & ~region_mask), bits});
    std::ranges::sort(code.constants);
    if (is_function) {
        Instruction& first = w.code.instructions[code.entry];
        first.c = temporaries - first.a;
    }
    const auto place = [&](auto& operand) {
        const Slot slot = static_cast<Slot>(operand);
        const Slot region = slot & region_mask, at = slot & ~region_mask;
        if (region == Region::temporary) operand = temporaries + at;
        if (region == Region::constant) operand = constants + at;
        if (region == Region::window) operand = windows + at;
    };
    for (std::uint32_t i = code.entry; i < code.end; ++i) {
        Instruction& in = w.code.instructions[i];
        const std::string_view operands = info(in.op).operands;
        const auto is_slot = [&](std::size_t k) {
            return std::string_view("wrsdt").find(operands[k]) != std::string_view::npos;
        };
        if (is_slot(0)) place(in.a);
        if (is_slot(1)) place(in.b);
        if (is_slot(2)) place(in.c);
        if (is_slot(3)) place(in.d);
        if (w.fuses) w.thread(i);
    }
    std::uint32_t end = windows + w.windows;
    if (is_function) end = std::max(end, w.code.instructions[code.entry].a + 1);
    if (!is_function) w.image->resize(end, 0);
    code.frame = end;
    if (routine.ring != 0) code.temporaries = {temporaries, windows};
    frame_of.frame = std::max(frame_of.frame, end);
    --w.unwritten_parts[&frame_of];
}

/// Siemens: the operating system tells an organization block of its first call.
void tell_initial_call(Writing& w, const Routine& routine) {
    const bool is_told =
        routine.pou->kind == PouKind::program && routine.pou->place.dialect().has_s7_instructions;
    if (!is_told) return;
    for (const Variable& input : routine.variables) {
        const bool is_flag = input.section == Section::input && input.type->kind == Kind::boolean;
        if (!is_flag || !same_name(input.text, "Initial_Call")) continue;
        const Slot scans = w.new_temporary();
        w.put(Op::scans_now, scans);
        w.put(Op::eq_word, input.slot, scans, w.constant_slot(0));
    }
}

void write(Writing& w, Routine& routine) {
    begin(w, routine);
    begin_mockable(w, routine);
    tell_initial_call(w, routine);
    w.cover(CoverPoint::Kind::function, routine.pou->place);
    write_block(w, routine.body);
    w.leave();
    finish(w, routine);
}

}  // namespace

Generated generate(Checked& checked, Diagnostics& out, const CodeOptions& options) {
    Writing w{checked, out, options};
    w.code.globals = static_cast<std::uint32_t>(w.checked.globals.size());
    w.code.has_references = w.checked.has_references;
    for (Routine* routine : w.checked.order)
        for (const Called& called : routine->calls)
            routine->depth = std::max(routine->depth, called.routine->depth + 1);
    for (const Routine& routine : w.checked.routines) {
        if (!routine.is_test()) continue;
        w.has_tests = true;
        routine.owner->depth = std::max(routine.owner->depth, routine.depth);
    }
    prepare_dispatch(w);
    w.fuses = !w.options.counted && !w.options.covered && !w.has_tests;
    forget_places(w);
    const auto is_list = [](const Global& global) {
        return global.type->kind == Kind::structure && global.name != image_name;
    };
    for (const Global& global : w.checked.globals)
        if (is_list(global))
            lay_out_members(w, *global.type, false);
        else if (global.type->kind != Kind::block && global.name != image_name)
            slots_of(w, *global.type);
    for (const Routine* routine : w.checked.order)
        w.numbers[routine] = static_cast<std::uint32_t>(w.numbers.size());
    for (Routine* routine : w.checked.order) {
        if (!w.out.empty()) return {};
        if (routine->plain_ring != 0) lay_out_ring(w, routine->plain_ring);
        write(w, *routine);
    }
    if (!w.out.empty()) return {};
    finish_dispatch(w);
    for (const Global& global : w.checked.globals)
        if (is_list(global)) lay_out_members(w, *global.type, true);
    finish_late(w);
    if (!w.out.empty()) return {};
    for (const Global& global : w.checked.globals) {
        Writing::Image image(slots_of(w, *global.type), 0);
        fill_default(w, image, 0, *global.type);
        if (global.pou) fill_assigned(w, image, global.pou->body);
        if (global.name == image_name) fill_process_image(w, image);
        w.images[global.type] = std::move(image);
    }
    fill_paths(w);
    finish_images(w);
    finish_shapes(w);
    finish_recursion(w);
    w.link();
    return {std::move(w.code), std::move(w.images), std::move(w.assertions)};
}

}  // namespace lineshaft::st
