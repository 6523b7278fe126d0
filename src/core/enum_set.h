// A set of the values of an enumeration, one bit each.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace whit {

// Every set has the bits `kAlways`.
template <typename Enum, int kCount, std::uint32_t kAlways = 0>
class EnumSet {
 public:
  constexpr EnumSet() = default;
  constexpr explicit EnumSet(std::uint32_t bits) : bits_(bits | kAlways) {}
  constexpr EnumSet(std::initializer_list<Enum> values) {
    for (const Enum value : values) bits_ |= bit(value);
  }
  static constexpr EnumSet all() { return EnumSet((1u << kCount) - 1); }

  constexpr bool has(Enum e) const { return (bits_ & bit(e)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr bool holds(EnumSet s) const { return (s.bits_ & ~bits_) == 0; }

  constexpr EnumSet with(EnumSet s) const { return EnumSet(bits_ | s.bits_); }
  constexpr EnumSet with(Enum e, bool on = true) const {
    return EnumSet(on ? bits_ | bit(e) : bits_);
  }
  constexpr EnumSet without(EnumSet s) const { return EnumSet(bits_ & ~s.bits_); }
  constexpr EnumSet without(Enum e) const { return EnumSet(bits_ & ~bit(e)); }

  constexpr std::uint32_t bits() const { return bits_; }
  constexpr bool operator==(const EnumSet&) const = default;

  // visit(value) for each, in the order of the enumeration.
  template <typename Visitor>
  constexpr void forEach(Visitor&& visit) const {
    for (int i = 0; i < kCount; ++i) {
      if (has(static_cast<Enum>(i))) visit(static_cast<Enum>(i));
    }
  }

 private:
  static constexpr std::uint32_t bit(Enum e) { return 1u << static_cast<std::uint32_t>(e); }
  std::uint32_t bits_ = kAlways;
};

}  // namespace whit
