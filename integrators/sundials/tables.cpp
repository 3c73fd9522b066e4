#include "integrators/sundials/tables.hpp"

#include <sundials/sundials_config.h>

#include <algorithm>

namespace gnomon::sundials {

Table explicit_table(ARKODE_ERKTableID id) {
  Table table(ARKodeButcherTable_LoadERK(id));
  constexpr bool reuses_any =
      SUNDIALS_VERSION_MAJOR < 6 || (SUNDIALS_VERSION_MAJOR == 6 && SUNDIALS_VERSION_MINOR < 7);
  if (!table || !reuses_any) return table;
  const int last = table->stages - 1;
  const bool is_end = std::equal(table->b, table->b + table->stages, table->A[last]);
  if (!is_end && table->c[last] == 1.0) table->c[last] -= 2e-10;
  return table;
}

}  // namespace gnomon::sundials
