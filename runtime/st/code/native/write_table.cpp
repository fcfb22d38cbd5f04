/// Writes the stencils of an object file as a table in C++; see native/README.md.
///
/// usage: write_table STENCILS.o > TABLE.cpp

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <elf.h>

#include "runtime/st/code/native/decoding.hpp"
#include "runtime/st/code/native/stencil.hpp"
#include "runtime/st/code/opcodes.hpp"

using namespace lineshaft::st;

namespace {

const std::map<std::string, Hole> holes{
#define HOLE(name) {#name, Hole::name},
    LINESHAFT_ST_HOLES(HOLE)
#undef HOLE
};

const std::map<std::uint64_t, Width> widths{{R_X86_64_32, Width::absolute_32},
                                            {R_X86_64_32S, Width::absolute_32_signed},
                                            {R_X86_64_64, Width::absolute_64},
                                            {R_X86_64_PC32, Width::relative_32},
                                            {R_X86_64_PLT32, Width::relative_32}};

constexpr unsigned char jump_byte = 0xE9, call_byte = 0xE8, return_byte = 0xC3,
                        short_jump_byte = 0xEB;
constexpr std::uint32_t jump_size = 5;

bool is_way(Hole hole) {
    return hole >= Hole::next_instruction && hole <= Hole::called_routine;
}

/// A relocatable file of this machine's kind, as elf(5) describes it.
class Object {
  public:
    explicit Object(std::string bytes) : bytes_(std::move(bytes)) {
        const auto header = at<Elf64_Ehdr>(0);
        if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_type != ET_REL ||
            header.e_machine != EM_X86_64)
            throw std::runtime_error("no object file for x86-64");
        for (std::size_t i = 0; i < header.e_shnum; ++i)
            sections.push_back(at<Elf64_Shdr>(header.e_shoff + i * sizeof(Elf64_Shdr)));
        names_ = sections.at(header.e_shstrndx).sh_offset;
        for (const Elf64_Shdr& section : sections) {
            if (section.sh_type != SHT_SYMTAB) continue;
            symbol_names_ = sections.at(section.sh_link).sh_offset;
            symbols = all<Elf64_Sym>(section);
        }
    }

    template <class T>
    std::vector<T> all(const Elf64_Shdr& section) const {
        std::vector<T> found;
        for (std::size_t i = 0; i < section.sh_size; i += sizeof(T))
            found.push_back(at<T>(section.sh_offset + i));
        return found;
    }
    std::string name(const Elf64_Shdr& section) const {
        return bytes_.c_str() + names_ + section.sh_name;
    }
    std::string name(const Elf64_Sym& symbol) const {
        return bytes_.c_str() + symbol_names_ + symbol.st_name;
    }
    std::vector<unsigned char> content(std::size_t section) const {
        return all<unsigned char>(sections.at(section));
    }
    std::vector<Elf64_Rela> relocations(std::size_t of) const {
        for (const Elf64_Shdr& section : sections)
            if (section.sh_type == SHT_RELA && section.sh_info == of)
                return all<Elf64_Rela>(section);
        return {};
    }
    const Elf64_Sym* find(const std::string& wanted) const {
        for (const Elf64_Sym& symbol : symbols)
            if (name(symbol) == wanted) return &symbol;
        return nullptr;
    }

    std::vector<Elf64_Shdr> sections;
    std::vector<Elf64_Sym> symbols;

  private:
    template <class T>
    T at(std::size_t place) const {
        T value;
        if (place + sizeof value > bytes_.size()) throw std::runtime_error("cut short");
        std::memcpy(&value, bytes_.data() + place, sizeof value);
        return value;
    }

    std::string bytes_;
    std::size_t names_ = 0, symbol_names_ = 0;
};

class Table {
  public:
    explicit Table(const Object& object) : object_(object) {}

    void add(const OpInfo& op) {
        const std::string symbol = "stencil_" + std::string(op.name);
        const Elf64_Sym* const entry = object_.find(symbol);
        if (!entry) throw std::runtime_error(symbol + " is missing");
        const Elf64_Sym* const rest = object_.find(symbol + ".cold");
        hot_ = entry->st_shndx;
        cold_ = rest ? rest->st_shndx : SHN_UNDEF;
        const bool is_alone = object_.sections.at(hot_).sh_size == entry->st_size;
        if (!is_alone) throw std::runtime_error(symbol + " is not alone in its section");
        try {
            add_code();
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(symbol + " " + error.what());
        }
    }

    void write() const {
        std::puts("#include \"runtime/st/code/native/stencil.hpp\"\n");
        for (std::size_t i = 0; i < externals_.size(); ++i)
            std::printf("extern \"C\" const char external_%zu[] asm(\"%s\");\n", i,
                        externals_[i].c_str());
        std::puts("\nnamespace lineshaft::st {\n\nconst Stencil stencils[] = {");
        for (const Stencil& s : stencils_)
            std::printf("{%u, %u, %u, %u, %u, %d, %d, %d, Hole{%d}, %d},\n", s.code, s.size,
                        s.cold_size, s.fillings, s.count, s.load, s.into, s.result,
                        static_cast<int>(s.written), s.spoils);
        std::puts("};\nconst Filling stencil_fillings[] = {");
        for (const Filling& f : fillings_)
            std::printf("{%u, Hole{%d}, Width{%d}, %d, %u, ReadAs{%d}, %d},\n", f.at,
                        static_cast<int>(f.hole), static_cast<int>(f.width), f.addend, f.number,
                        static_cast<int>(f.read_as), f.before);
        write("stencil_code", code_);
        write("stencil_constants", constants_);
        std::printf("};\nconst std::size_t stencil_constants_size = %zu;\n", constants_.size());
        std::printf("const std::size_t stencil_externals_count = %zu;\n", externals_.size());
        std::puts("const void* const stencil_externals[] = {");
        for (std::size_t i = 0; i < externals_.size(); ++i) std::printf("external_%zu,\n", i);
        std::puts("nullptr};\nconst char* const stencil_external_names[] = {");
        for (const std::string& name : externals_) std::printf("\"%s\",\n", name.c_str());
        std::puts("nullptr};\n\n}  // namespace lineshaft::st");
    }

  private:
    using Bytes = std::vector<unsigned char>;

    static void write(const char* name, const Bytes& bytes) {
        std::printf("};\nalignas(16) const unsigned char %s[] = {\n", name);
        for (std::size_t i = 0; i < bytes.size(); ++i)
            std::printf("%u,%s", bytes[i], i % 32 == 31 ? "\n" : "");
        std::puts("0");
    }

    /// A short jump may be that far.
    static bool ends_with_return(const Bytes& code) {
        return code.back() == return_byte &&
               (code.size() < 2 || code[code.size() - 2] != short_jump_byte);
    }

    void add_code() {
        Bytes hot = object_.content(hot_);
        std::vector<Filling> found = fillings(hot_, hot);
        if (hot.empty() || ends_with_return(hot)) throw std::runtime_error("returns");
        const auto last = static_cast<std::uint32_t>(hot.size()) - jump_size;
        if (hot.size() >= jump_size && hot[last] == jump_byte)
            if (std::erase_if(found, [&](const Filling& f) {
                    return f.hole == Hole::next_instruction && f.at == last + 1;
                }) == 1)
                hot.resize(last);
        Stencil made{static_cast<std::uint32_t>(code_.size()),
                     static_cast<std::uint32_t>(hot.size()),
                     0,
                     static_cast<std::uint32_t>(fillings_.size()),
                     0,
                     0,
                     no_register,
                     no_register,
                     Hole::external,
                     0xFF};
        look_into(made, hot, found);
        code_.insert(code_.end(), hot.begin(), hot.end());
        if (cold_ != SHN_UNDEF) {
            const Bytes cold = object_.content(cold_);
            for (Filling& filling : fillings(cold_, cold)) {
                filling.at += made.size;
                found.push_back(filling);
                if (filling.hole == Hole::own) made.spoils = 0xFF;  // behind a call
            }
            made.cold_size = static_cast<std::uint32_t>(cold.size());
            code_.insert(code_.end(), cold.begin(), cold.end());
        }
        fillings_.insert(fillings_.end(), found.begin(), found.end());
        made.count = static_cast<std::uint32_t>(found.size());
        stencils_.push_back(made);
    }

    /// What its registers have at its beginning and its end, and which slots it may as well read
    /// there; nothing of code that is not understood.
    static void look_into(Stencil& made, const Bytes& hot, std::vector<Filling>& found) {
        if (hot.empty() || std::ranges::count(found, Hole::own, &Filling::hole) > 0) return;
        std::vector<ProcessorInstruction> all;
        Decoding decoding(hot);
        for (std::size_t at = 0; at < hot.size(); at += all.back().size) {
            const auto next = decoding.at(at);
            if (!next) return;
            all.push_back(*next);
        }
        std::uint8_t spoils = 0;
        for (const ProcessorInstruction& one : all) {
            spoils |= one.late_registers();
            if (Filling* const slot = slot_of(one, found)) look_at(one, *slot);
        }
        const auto is_reached = [&](std::size_t first, std::size_t last) {
            return std::ranges::any_of(all, [&](const ProcessorInstruction& one) {
                return one.way && first <= *one.way && *one.way <= last;
            });
        };
        const auto goes_on = [](const Filling& f) { return f.hole == Hole::next_instruction; };
        made.spoils = spoils;
        const ProcessorInstruction &first = all.front(), &last = all.back();
        if ((first.loads_word() || first.loads_real()) && slot_of(first, found) &&
            !is_reached(0, first.size - 1)) {
            made.load = static_cast<std::uint8_t>(first.size);
            made.into = register_of(first);
        }
        const Filling* const written = slot_of(last, found);
        if ((last.stores_word() || last.stores_real()) && written && last.named_register() < 8 &&
            !is_reached(hot.size(), hot.size()) && std::ranges::none_of(found, goes_on)) {
            made.result = register_of(last);
            made.written = written->hole;
        }
    }

    static std::uint8_t register_of(const ProcessorInstruction& move) {
        const bool is_real = move.loads_real() || move.stores_real();
        return static_cast<std::uint8_t>(move.named_register() + (is_real ? first_real : 0));
    }

    /// The filling of a slot in that instruction.
    static Filling* slot_of(const ProcessorInstruction& one, std::vector<Filling>& found) {
        if (!one.has_slot()) return nullptr;
        const auto it = std::ranges::find_if(found, [&](const Filling& f) {
            return f.at == one.place_at && f.hole <= Hole::d_bytes && f.addend == 0;
        });
        return it == found.end() ? nullptr : &*it;
    }

    static void look_at(const ProcessorInstruction& one, Filling& slot) {
        if (one.reads_word())
            slot.read_as = ReadAs::word;
        else if (one.reads_real())
            slot.read_as = ReadAs::real;
        slot.before = static_cast<std::uint8_t>(one.place_at - one.at);
    }

    std::vector<Filling> fillings(std::size_t section, const Bytes& code) {
        std::vector<Filling> found;
        for (const Elf64_Rela& relocation : object_.relocations(section)) {
            const Filling filling = fill(relocation);
            if (is_way(filling.hole) && code.at(filling.at - 1) == call_byte)
                throw std::runtime_error("calls where it should jump");
            found.push_back(filling);
        }
        return found;
    }

    Filling fill(const Elf64_Rela& relocation) {
        const auto type = ELF64_R_TYPE(relocation.r_info);
        if (!widths.contains(type))
            throw std::runtime_error("has an unknown relocation: " + std::to_string(type));
        const Elf64_Sym& symbol = object_.symbols.at(ELF64_R_SYM(relocation.r_info));
        Filling made{static_cast<std::uint32_t>(relocation.r_offset),
                     Hole::external,
                     widths.at(type),
                     static_cast<std::int32_t>(relocation.r_addend),
                     0,
                     ReadAs::memory,
                     0};
        const bool is_relative = made.width == Width::relative_32;
        if (symbol.st_shndx == SHN_UNDEF) {
            const std::string name = object_.name(symbol);
            if (const auto hole = holes.find(name); hole != holes.end())
                made.hole = hole->second;
            else if (is_relative)
                made.number = external(name);
            else
                throw std::runtime_error("takes the address of " + name);
            return made;
        }
        made.number = static_cast<std::uint32_t>(symbol.st_value);
        if (symbol.st_shndx == cold_) return through(made);
        if (symbol.st_shndx == hot_) {
            made.hole = Hole::own;
            return made;
        }
        const bool is_constant =
            object_.name(object_.sections.at(symbol.st_shndx)).starts_with(".rodata");
        if (!is_constant || !is_relative)
            throw std::runtime_error(
                "refers to something in its object: move what uses it to "
                "meaning.cpp");
        made.hole = Hole::constant;
        made.number += constants(symbol.st_shndx);
        return made;
    }

    /// A jump to a jump in the cold code goes where that goes.
    Filling through(Filling made) {
        made.hole = Hole::own_cold;
        const std::uint32_t target = made.number + static_cast<std::uint32_t>(made.addend + 4);
        if (object_.content(cold_).at(target) != jump_byte) return made;
        for (const Elf64_Rela& relocation : object_.relocations(cold_)) {
            if (relocation.r_offset != target + 1) continue;
            const Filling jump = fill(relocation);
            if (!is_way(jump.hole)) continue;
            made.hole = jump.hole;
            made.addend = jump.addend;
        }
        return made;
    }

    std::uint32_t external(const std::string& name) {
        for (std::size_t i = 0; i < externals_.size(); ++i)
            if (externals_[i] == name) return static_cast<std::uint32_t>(i);
        externals_.push_back(name);
        return static_cast<std::uint32_t>(externals_.size() - 1);
    }

    /// Where a section of constants begins.
    std::uint32_t constants(std::size_t section) {
        const auto [it, is_new] = begins_.try_emplace(section, 0);
        if (!is_new) return it->second;
        if (!object_.relocations(section).empty())
            throw std::runtime_error("has constants that are addresses");
        constants_.resize((constants_.size() + 15) / 16 * 16);
        it->second = static_cast<std::uint32_t>(constants_.size());
        const Bytes bytes = object_.content(section);
        constants_.insert(constants_.end(), bytes.begin(), bytes.end());
        return it->second;
    }

    const Object& object_;
    std::size_t hot_ = 0, cold_ = 0;  ///< sections of the stencil at hand
    std::vector<Stencil> stencils_;
    std::vector<Filling> fillings_;
    std::vector<std::string> externals_;
    Bytes code_, constants_;
    std::map<std::size_t, std::uint32_t> begins_;
};

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) return 2;
    std::ifstream file(arguments[1], std::ios::binary);
    try {
        const Object object({std::istreambuf_iterator<char>(file), {}});
        Table table(object);
        for (const OpInfo& op : op_infos) table.add(op);
        table.write();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", arguments[1], error.what());
        return 1;
    }
    return 0;
}
