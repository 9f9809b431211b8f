// Views of an open file for copies of its memory (acdf/moved.h).
#pragma once

#include <acdf/moved.h>
#include <acdf/reader.h>
#include <acdf/views.h>
#include <acdf/visibility/visibility.h>
#include <acdf/visibility/visibility_c.h>

namespace acdf_test {

inline acdf::EnvironmentView moved(const acdf::EnvironmentView& view, const AcdfMove* moves, int count) {
    AcdfEnvironment data = view.data();
    acdf_move_environment(&data, moves, count);
    return acdf::EnvironmentView(data);
}
inline acdf::LocalEnvironmentView moved(const acdf::LocalEnvironmentView& view, const AcdfMove* moves, int count) {
    AcdfLocal data = view.data();
    acdf_move_local(&data, moves, count);
    return acdf::LocalEnvironmentView(data);
}
inline acdf::VisibleLocalView moved(const acdf::VisibleLocalView& view, const AcdfMove* moves, int count) {
    AcdfVisibleLocal data = view.data();
    acdf_move_visible_local(&data, moves, count);
    return acdf::VisibleLocalView(data);
}
inline acdf::BrdfView moved(const acdf::BrdfView& view, const AcdfMove* moves, int count) {
    AcdfBrdf data = view.data();
    acdf_move_brdf(&data, moves, count);
    return acdf::BrdfView(data);
}
inline acdf::TableView moved(const acdf::TableView& view, const AcdfMove* moves, int count) {
    AcdfTable data = view.data();
    acdf_move_table(&data, moves, count);
    return acdf::TableView(data);
}

} // namespace acdf_test
