#pragma once
#include <cstdio>  // SUNDIALS 6.4 needs it first

#include <arkode/arkode_butcher_erk.h>

#include <memory>
#include <type_traits>

namespace gnomon::sundials {

struct TableDeleter {
  void operator()(ARKodeButcherTable table) const { ARKodeButcherTable_Free(table); }
};
using Table = std::unique_ptr<std::remove_pointer_t<ARKodeButcherTable>, TableDeleter>;

/// An explicit table as ERKStep has to be given it. Before 6.7, ERKStep takes the rate of a last stage with
/// c = 1 for that at the end of the step, also where that stage is not the end (LLNL/sundials issue 311);
/// 8th order becomes 7th. Such a stage is moved by 2e-10 of the step, which ERKStep sees and solutions do
/// not: c only says when loads are evaluated. Null where there is no table of that number.
Table explicit_table(ARKODE_ERKTableID id);

}  // namespace gnomon::sundials
