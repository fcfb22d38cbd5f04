#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lineshaft {

template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Collects what must be kept to go on later, as bytes. Plain data without pointers only; read back
/// by the same version on the same kind of machine.
class StateWriter {
  public:
    template <Plain T>
    void put(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <Plain T, class Allocator>
    void put(const std::vector<T, Allocator>& values) {
        put(std::uint64_t{values.size()});
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        bytes_ += text;
    }

    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Reads in the order of the writing, whatever the bytes are: what is not there, and a boolean that
/// is none, leaves the target as it was and clears ok(). Whoever reads a number that not every
/// value is good for says so: require().
class StateReader {
  public:
    explicit StateReader(std::string_view bytes) : left_(bytes) {}

    template <Plain T>
    void get(T& value) {
        static_assert(!std::is_enum_v<T>, "get its number, and look at that");
        take(reinterpret_cast<char*>(&value), sizeof value);
    }
    void get(bool& value) {
        unsigned char byte = 0;
        get(byte);
        require(byte <= 1);
        if (ok_) value = byte == 1;
    }
    /// Within limits, both included.
    template <std::integral T>
    void get(T& value, std::type_identity_t<T> least, std::type_identity_t<T> most) {
        T read = value;
        get(read);
        require(read >= least && read <= most);
        if (ok_) value = read;
    }
    /// `values` has the size that was written, or it is not the same machine.
    template <Plain T, class Allocator>
    void get(std::vector<T, Allocator>& values) {
        std::uint64_t size = 0;
        get(size);
        ok_ = ok_ && size == values.size();
        take(reinterpret_cast<char*>(values.data()), values.size() * sizeof(T));
    }
    void get(std::string& text) {
        std::uint64_t size = 0;
        get(size);
        ok_ = ok_ && size <= left_.size();
        if (!ok_) return;
        text.resize(size);
        take(text.data(), size);
    }

    /// Else what was read cannot be.
    void require(bool condition) { ok_ = ok_ && condition; }
    /// `the state of 'x' (axis)`: what it is that cannot be, of the first.
    void require(bool condition, const std::string& what) {
        if (ok_ && !condition) wrong_ = what;
        require(condition);
    }

    bool ok() const { return ok_; }
    const std::string& wrong() const { return wrong_; }
    bool at_end() const { return ok_ && left_.empty(); }

  private:
    void take(char* target, std::size_t size) {
        ok_ = ok_ && size <= left_.size();
        if (!ok_ || size == 0) return;
        std::memcpy(target, left_.data(), size);
        left_.remove_prefix(size);
    }

    std::string_view left_;
    std::string wrong_;
    bool ok_ = true;
};

}  // namespace lineshaft
