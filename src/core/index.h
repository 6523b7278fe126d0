// Indices of type int and enumerators, which are not negative, as places in tables and grids; the
// indices of a table; and whether it has a value.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <ranges>

namespace whit {

template <typename Table, typename Index>
constexpr decltype(auto) entryOf(Table& table, Index index) {
  return table[static_cast<std::size_t>(index)];
}

// The number of entries. Vertices, triangles, materials and nodes are counted by 32 bits, so that
// it is also the number that the next entry gets.
template <typename Table>
constexpr std::uint32_t size32(const Table& table) {
  return static_cast<std::uint32_t>(std::size(table));
}

// True if the projection of an entry equals `value`.
template <typename Table, typename Value, typename Projection = std::identity>
constexpr bool contains(const Table& table, const Value& value, Projection projection = {}) {
  return std::ranges::find(table, value, projection) != std::ranges::end(table);
}

// The numbers from 0 that are less than `count`, as std::views::indices of C++26. Clang 14 cannot
// compile std::views::iota of g++ 12's library.
class Indices {
 public:
  struct Iterator {
    std::size_t number;
    constexpr std::size_t operator*() const { return number; }
    constexpr Iterator& operator++() {
      ++number;
      return *this;
    }
    bool operator==(const Iterator&) const = default;
  };

  constexpr explicit Indices(std::size_t count) : count_(count) {}
  constexpr Iterator begin() const { return {0}; }
  constexpr Iterator end() const { return {count_}; }

 private:
  std::size_t count_;
};

constexpr Indices indices(std::size_t count) { return Indices(count); }

template <typename Table>
requires requires(const Table& table) { std::size(table); }
constexpr auto indices(const Table& table) { return indices(std::size(table)); }

// Cells of a grid that is kept row by row.
constexpr std::size_t cellsOf(int columns, int rows) {
  return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
}

constexpr std::size_t cellAt(int column, int row, int columns) {
  return cellsOf(columns, row) + static_cast<std::size_t>(column);
}

}  // namespace whit
