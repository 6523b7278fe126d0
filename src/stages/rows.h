// One row of the columns in double, as the scalar reference writes it. Made from the same lists: a
// column that is added there is in its row, and is compared.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "stages/columns.h"

namespace whit {

template <typename Element>
using InRow = std::conditional_t<std::is_same_v<Element, float>, double, Element>;

#define WHIT_ROW_MEMBER(type, name, feature) InRow<type> name{};
#define WHIT_ROW_VISIT(type, name, feature) visit(#name, row.name, Feature::feature);
#define WHIT_ROW_COUNT(type, name, feature) +1
#define WHIT_ROW_VALUE(type, name, feature) static_cast<double>(name),
#define WHIT_ROW_LOAD(type, name, feature) \
  if (columns.name) row.name = static_cast<InRow<type>>(columns.name[i]);

// visit(name, value, feature). `at` leaves what the frame has no column for as it is made.
#define WHIT_DECLARE_ROW(Row, Struct, LIST)                                        \
  struct Row {                                                                     \
    using Columns = Struct;                                                        \
    static constexpr std::size_t kColumns = 0 LIST(WHIT_ROW_COUNT);                \
    LIST(WHIT_ROW_MEMBER)                                                          \
    static Row at(const Struct& columns, std::size_t i) {                          \
      Row row;                                                                     \
      LIST(WHIT_ROW_LOAD)                                                          \
      return row;                                                                  \
    }                                                                              \
    std::array<double, kColumns> values() const { return {LIST(WHIT_ROW_VALUE)}; } \
    template <typename Self, typename Visitor>                                     \
    static void forEachColumn(Self& row, Visitor&& visit) {                        \
      LIST(WHIT_ROW_VISIT)                                                         \
    }                                                                              \
  }

WHIT_DECLARE_ROW(RayRow, RayColumns, WHIT_RAY_COLUMNS);
WHIT_DECLARE_ROW(HitRow, HitColumns, WHIT_HIT_COLUMNS);
WHIT_DECLARE_ROW(SurfelRow, SurfelColumns, WHIT_SURFEL_COLUMNS);
WHIT_DECLARE_ROW(ShadowRow, ShadowColumns, WHIT_SHADOW_COLUMNS);
WHIT_DECLARE_ROW(UnshadowedRow, UnshadowedColumns, WHIT_UNSHADOWED_COLUMNS);
WHIT_DECLARE_ROW(RadianceRow, RadianceColumns, WHIT_RADIANCE_COLUMNS);

}  // namespace whit
