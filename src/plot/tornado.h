/* tornado.h - from a table with a row for each run to how far a result moves with each value. */
#ifndef DALCS_TORNADO_H
#define DALCS_TORNADO_H

#include "tornado_chart.h"
#include "waveforms.h"

/* Of the column `result`. In a table of .wcase the values are known, and the rows have each of them at its ends alone.
 * In any other one `values` names them, "r1,c1", and each moves the result by the plane that fits all rows best, over the
 * range that it has in them. NULL: not named. Bars and names are in the table's arena. Errors come with a message. */
enum dalcs_status dalcs_tornado_make(struct dalcs_tornado *tornado,
                                     struct dalcs_waveforms *waveforms, const char *result,
                                     const char *values, struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
