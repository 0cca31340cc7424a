/* page.h - waveforms as one HTML file to look around in: zoom, cursors, a list of signals. It loads
 * nothing from anywhere. */
#ifndef DALCS_PAGE_H
#define DALCS_PAGE_H

#include "margin_lines.h"
#include "selection.h"

#include <stdio.h>

/* False where the program was built without dygraphs. */
bool dalcs_page_is_available(void);

/* Of a sweep: a run besides the first, with the same signals. */
struct dalcs_page_run {
    struct dalcs_selection selection;
    struct dalcs_conduction conduction;
};

struct dalcs_page_runs {
    size_t n;
    const struct dalcs_page_run *run; /* [n - 1] the second one first */
    const char *const *label;         /* [n] */
};

struct dalcs_page {
    const struct dalcs_selection *selection; /* of the first run */
    const struct dalcs_conduction *conduction;
    const struct dalcs_page_runs *runs;
    const struct dalcs_margin_lines *lines;
    const char *title;
    const struct dalcs_theme *theme;
    bool marks; /* of events */
};

/* All signals of the selection are in the page; those of its panels are shown at first. Errors of the
 * stream stay there. DALCS_E_LIMIT comes with a message: too many values for one page. */
enum dalcs_status dalcs_page_write(FILE *stream, const struct dalcs_page *page,
                                   struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
