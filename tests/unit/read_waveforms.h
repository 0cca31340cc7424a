/* read_waveforms.h - waveforms of a text. */
#ifndef READ_WAVEFORMS_H
#define READ_WAVEFORMS_H

#include "sample_plot.h"
#include "selection.h"
#include "table.h"
#include "text_plot.h"

static struct dalcs_diag diag;

static inline const char *message(void) {
    return diag.n > 0 ? diag.item[diag.n - 1].text : "";
}

static inline void read_text(struct dalcs_waveforms *w, const char *text, size_t plot) {
    enum dalcs_status status = dalcs_waveforms_read_text(w, "a", text, strlen(text), plot, &diag);
    ck_assert_msg(status == DALCS_OK, "%s", message());
}

#endif
