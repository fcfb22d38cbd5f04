#include "runtime/st/library/library.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/library/fields.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

void add_routine(Library::Made& made, const Routine& routine, const CodeRoutine& code,
                 const Options& options) {
    KindContext& kind = add_kind(made, routine.name, *routine.type, options);
    kind.routine = &code;
    kind.doc = fmt::format("{} of {}",
                           routine.pou->kind == PouKind::program ? "PROGRAM" : "FUNCTION_BLOCK",
                           routine.pou->name.place.source->file->path);
    if (!routine.pou->doc.empty()) kind.doc += ": " + text_of_comments(routine.pou->doc);
    write_fields(made, kind, routine);
}

/// No program names anything of it.
bool is_for_pictures(std::string_view library) {
    return lower(library).starts_with("system_visu") || same_name(library, "VisuSymbols");
}

/// Also one whose names are here without it. A library that is here in parts says so.
bool is_here(const Catalog& standard, std::string_view library) {
    if (is_vendor_library(library) || is_for_pictures(library)) return true;
    const LibraryFile* file = find_called(standard.libraries(), library, &LibraryFile::library);
    return file && !file->text.starts_with("// In parts.");
}

}  // namespace

std::optional<Library> compile(const std::vector<std::shared_ptr<const SourceFile>>& sources,
                               const Catalog& standard, Diagnostics& out, const Options& options) {
    const auto made = std::make_shared<Library::Made>();
    made->sources = sources;
    made->tree.addresses = options.addresses;
    for (const LibraryReference& reference : options.references)
        (is_here(standard, reference.name) ? made->libraries : made->missing_libraries)
            .push_back(reference);
    const CodeOptions code_options{.overflow_faults = options.overflow_faults,
                                   .counted = options.times.has_value()};
    const bool is_compiled = compile(*made, standard, out, code_options);
    if (options.foreign)
        for (const Source* source : made->checked.foreign_users)
            options.foreign->insert(source->file.get());
    if (!is_compiled) return {};
    make_native(made->generated.code, options);
    std::unordered_map<const Routine*, const CodeRoutine*> codes;
    const CodeRoutine* code = made->generated.code.routines.data();
    for (const Routine* routine : made->checked.order) codes.emplace(routine, code++);
    for (const Routine& routine : made->checked.routines)
        if (routine.has_instances() && !routine.owner && !routine.pou->is_abstract &&
            routine.pou->place.source->is_users())
            add_routine(*made, routine, *codes.at(&routine), options);
    add_data_blocks(*made, options);
    Library library;
    library.made_ = made;
    for (KindContext& kind : made->kinds) library.kinds_.push_back(block_type(kind, made));
    if (const int image = made->checked.image.global; image >= 0)
        library.kinds_.push_back(
            image_type(*made, made, made->checked.globals[static_cast<std::size_t>(image)]));
    return library;
}

std::vector<std::pair<std::string_view, Mark>> Library::configured_programs() const {
    const auto is_kind = [&](std::string_view name) {
        return std::ranges::any_of(
            kinds_, [&](const BlockType& kind) { return same_name(kind.name, name); });
    };
    std::vector<std::pair<std::string_view, Mark>> programs;
    for (const ProgramInstance& program : made_->tree.instances)
        programs.emplace_back(is_kind(program.path) ? program.path : program.type.text,
                              program.name.place.mark());
    return programs;
}

bool Library::is_called(std::string_view program) const {
    const auto is_it = [&](const Called& called) {
        return called.is_call && called.routine->pou->kind == PouKind::program &&
               same_name(called.routine->name, program);
    };
    return std::ranges::any_of(made_->checked.routines, [&](const Routine& routine) {
        return !routine.pou->is_configured && !same_name(routine.name, program) &&
               std::ranges::any_of(routine.calls, is_it);
    });
}

FaultPlace Library::fault(const BlockType& kind, const std::byte* instance) const {
    const bool is_image = kind.context == &made_->image;
    if (is_image || !static_cast<const KindContext*>(kind.context)->routine) return {};
    return fault_of(made_->generated.code, instance);
}

std::span<const std::uint64_t, op_classes> Library::counts(const std::byte* instance) const {
    return std::span<const std::uint64_t, op_classes>(
        std::launder(reinterpret_cast<const std::uint64_t*>(instance)) + counts_slot, op_classes);
}

std::string Library::listing() const {
    return st::listing(made_->generated.code);
}

}  // namespace lineshaft::st
