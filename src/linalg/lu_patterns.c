/* lu_patterns.c - see lu_patterns.h. */
#include "lu_patterns.h"

#include <stdlib.h>
#include <string.h>

/* Of patterns that are kept behind a run: some 10 MB. */
static const size_t MOST_ENTRIES = (size_t)1 << 20;

static void forget(struct dalcs_lu_pattern *known, klu_common *common) {
    klu_free_symbolic(&known->symbolic, common);
    free(known->p);
}

void dalcs_lu_patterns_finish(struct dalcs_lu_patterns *patterns, klu_common *common) {
    for (int k = 0; k < patterns->n; k++) {
        forget(&patterns->known[k], common);
    }
    free(patterns->known);
    *patterns = (struct dalcs_lu_patterns){0};
}

static bool is_it(const struct dalcs_lu_pattern *known, bool keeps_diagonal,
                  const struct dalcs_columns *a) {
    return known->n == a->n && known->keeps_diagonal == keeps_diagonal &&
           memcmp(known->p, a->p, ((size_t)a->n + 1) * sizeof(*a->p)) == 0 &&
           memcmp(known->p + a->n + 1, a->i, (size_t)a->p[a->n] * sizeof(*a->i)) == 0;
}

/* Number `from` becomes the first. */
static void put_first(struct dalcs_lu_patterns *patterns, int from) {
    struct dalcs_lu_pattern known = patterns->known[from];
    memmove(patterns->known + 1, patterns->known, (size_t)from * sizeof(known));
    patterns->known[0] = known;
}

/* Is there no room for one more with so many entries? Those of a run are few enough in any case. */
static bool are_full(const struct dalcs_lu_patterns *patterns, int most, size_t more) {
    size_t sum = more;
    for (int k = 0; k < patterns->n; k++) {
        sum += (size_t)patterns->known[k].p[patterns->known[k].n];
    }
    return patterns->n == most || (most > DALCS_LU_PATTERNS && sum > MOST_ENTRIES);
}

static enum dalcs_status analyse(struct dalcs_lu_patterns *patterns, klu_common *common,
                                 bool keeps_diagonal, const struct dalcs_columns *a) {
    const size_t n_starts = (size_t)a->n + 1;
    const size_t n_entries = (size_t)a->p[a->n];
    const int most = patterns->most > 0 ? patterns->most : DALCS_LU_PATTERNS;
    struct dalcs_lu_pattern made = {.n = a->n, .keeps_diagonal = keeps_diagonal};
    if (patterns->known == NULL) {
        patterns->known = dalcs_alloc((size_t)most, sizeof(*patterns->known));
    }
    if (patterns->known == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_lu_analyze(&made.symbolic, common, a));
    made.p = malloc((n_starts + n_entries) * sizeof(*made.p));
    if (made.p == NULL) {
        forget(&made, common);
        return DALCS_E_NOMEM;
    }
    memcpy(made.p, a->p, n_starts * sizeof(*a->p));
    memcpy(made.p + n_starts, a->i, n_entries * sizeof(*a->i));
    while (patterns->n > 0 && are_full(patterns, most, n_entries)) {
        forget(&patterns->known[--patterns->n], common);
    }
    patterns->known[patterns->n] = made;
    put_first(patterns, patterns->n++);
    return DALCS_OK;
}

enum dalcs_status dalcs_lu_factor_again(struct dalcs_lu *lu, struct dalcs_lu_patterns *patterns,
                                        klu_common *common, const struct dalcs_columns *a,
                                        double rcond_min) {
    const bool keeps_diagonal = common->btf == 0;
    *lu = (struct dalcs_lu){.n = a->n};
    if (a->n == 0) {
        return DALCS_OK;
    }
    int k = 0;
    while (k < patterns->n && !is_it(&patterns->known[k], keeps_diagonal, a)) {
        k++;
    }
    if (k < patterns->n) {
        put_first(patterns, k);
    } else {
        enum dalcs_status status = analyse(patterns, common, keeps_diagonal, a);
        if (status != DALCS_OK) {
            dalcs_lu_finish(lu);
            return status;
        }
    }
    return dalcs_lu_factor_analyzed(lu, common, patterns->known[0].symbolic, NULL, a, rcond_min);
}
