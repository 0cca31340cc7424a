/* screen_rows.h - what the files that fill the rows of a screen share. */
#ifndef DALCS_AUDIT_SCREEN_ROWS_H
#define DALCS_AUDIT_SCREEN_ROWS_H

#include "screen.h"

struct audit_filling {
    struct dalcs_audit *audit;
    struct audit_part *part;
    struct audit_watch *watch;
    const struct dalcs_audit_state *s; /* of the mode */
    int index;                         /* of the part */
    double step;                       /* s */
};

/* The sum of laws at one time. */
static inline struct dalcs_audit_row *audit_row_now(const struct audit_filling *f) {
    return &f->watch->fill.row[AUDIT_ROW_NOW];
}

/* The factor of a law of which so much is allowed. */
static inline double audit_over(const struct audit_filling *f, double allowed) {
    return audit_screen_weight(f->audit) / fmax(allowed, 0x1p-500);
}

/* Of a branch, or between the two nodes that control it. */
void audit_add_voltage(const struct audit_filling *f, struct dalcs_audit_row *row,
                       const struct dalcs_device *d, int first, double factor);
void audit_add_read_current(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                            double factor);
void audit_add_affine(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                      const struct dalcs_affine *a, double factor);

/* value / allowed >= -1, of the row for signs, which is empty thereafter. */
void audit_put_sign(struct audit_filling *f);

/* screen_branches.c: the law of a device that is not Kirchhoff's, and its signs. */
void audit_fill_branch(struct audit_filling *f, int device);

#endif
