/* screen.c - the screens of a part: found by key, made, kept in a table of bounded size. */
#include "screen.h"

#include "quads.h"

#include <stdlib.h>
#include <string.h>

/* Numbers that all screens of a part may have, about, and screens. */
enum { MOST_NUMBERS = 1 << 17, MOST_SCREENS = 256, FEWEST_SCREENS = 4 };

/* A multiplier whose product spreads keys (D. E. Knuth, The Art of Computer Programming 3, sec. 6.4). */
static const uint64_t spread = 0x9e3779b97f4a7c15u;

static struct audit_screen *slot_of(const struct audit_watch *watch, uint64_t key) {
    return &watch->screen[(key * spread) >> (64 - watch->log2_screens)];
}

struct audit_screen *audit_screen_of(const struct audit_part *part,
                                     const struct dalcs_audit_polynomials *p) {
    const struct audit_watch *watch = part->watch;
    if (watch->screen == NULL) {
        return NULL;
    }
    struct audit_screen *screen = slot_of(watch, p->key);
    return screen->is_made && screen->key == p->key ? screen : NULL;
}

static void find_barycentric(const struct dalcs_audit_polynomials *p, double *barycentric) {
    for (int k = 0; k < p->n_nodes; k++) {
        double product = 1.0;
        for (int i = 0; i < p->n_nodes; i++) {
            product *= i != k ? p->node[k] - p->node[i] : 1.0;
        }
        barycentric[k] = 1.0 / product;
    }
}

double audit_screen_weight(struct dalcs_audit *audit) {
    const double draw = 2.0 * audit_draw(audit) - 1.0;
    return draw < 0.0 ? 0.5 * (draw - 1.0) : 0.5 * (draw + 1.0);
}

static bool start_row(struct dalcs_audit *audit, struct dalcs_audit_row *row, int n_columns) {
    const size_t n_stimuli = (size_t)audit->circuit->n_stimuli;
    const size_t n = (size_t)n_columns;
    row->column = dalcs_arena_alloc(&audit->arena, n, sizeof(double));
    row->listed_column = dalcs_arena_alloc(&audit->arena, n, sizeof(int));
    row->has_column = dalcs_arena_alloc(&audit->arena, n, sizeof(bool));
    row->stimulus = dalcs_arena_alloc(&audit->arena, n_stimuli, sizeof(double));
    row->listed_stimulus = dalcs_arena_alloc(&audit->arena, n_stimuli, sizeof(int));
    row->has_stimulus = dalcs_arena_alloc(&audit->arena, n_stimuli, sizeof(bool));
    return row->column != NULL && row->listed_column != NULL && row->has_column != NULL &&
           row->stimulus != NULL && row->listed_stimulus != NULL && row->has_stimulus != NULL;
}

/* How much of the state of a device is nothing; 0: it has none, or one that sources set. */
static double allowed_of_state(const struct dalcs_audit *audit, const struct audit_part *part,
                               int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (d->kind == DALCS_INDUCTOR) {
        return part->tolerance * audit_amperes(audit, part, device) + audit->options.abstol;
    }
    const bool is_held = audit->is_held[d->node[0]] && audit->is_held[d->node[1]];
    return d->kind == DALCS_CAPACITOR && !is_held
               ? part->tolerance * audit_volts(audit, part, d->node[0], d->node[1]) +
                     audit->options.vntol
               : 0.0;
}

/* What a scale may grow to before states are held to it. */
static const double much = 4.0;

void audit_screen_rescale(const struct dalcs_audit *audit, struct audit_part *part) {
    struct audit_watch *watch = part->watch;
    bool has_grown = false;
    for (int k = 0; k < part->n_devices && watch->screen != NULL; k++) {
        const double allowed = allowed_of_state(audit, part, part->device[k]);
        has_grown |= allowed * fabs(watch->state_factor[k]) > much;
    }
    if (!has_grown) {
        return;
    }
    for (int k = 0; k < part->n_devices; k++) {
        const double allowed = allowed_of_state(audit, part, part->device[k]);
        watch->state_factor[k] =
            allowed > 0.0 ? copysign(1.0 / allowed, watch->state_factor[k]) : 0.0;
    }
    for (int k = 0; k < 1 << watch->log2_screens; k++) {
        watch->screen[k].is_made = false;
    }
    watch->knows_states = false;
}

/* [n_devices] how the state of a coil or a capacitor goes into the sum of states. */
static bool draw_states(struct dalcs_audit *audit, const struct audit_part *part,
                        struct audit_watch *watch) {
    watch->state_factor = dalcs_arena_alloc(&audit->arena, (size_t)part->n_devices, sizeof(double));
    watch->node_weight =
        dalcs_arena_alloc(&audit->arena, 2 * (size_t)audit->circuit->n_nodes, sizeof(double));
    for (int k = 0; watch->state_factor != NULL && k < part->n_devices; k++) {
        const double allowed = allowed_of_state(audit, part, part->device[k]);
        watch->state_factor[k] = allowed > 0.0 ? audit_screen_weight(audit) / allowed : 0.0;
    }
    return watch->state_factor != NULL && watch->node_weight != NULL;
}

/* Once for each part. */
static bool start(struct dalcs_audit *audit, struct audit_part *part,
                  const struct dalcs_audit_polynomials *p) {
    if (p->n_nodes > AUDIT_MOST_NODES) {
        return false;
    }
    struct audit_watch *watch = part->watch;
    const int each =
        AUDIT_N_ROWS * p->n_columns + AUDIT_SCREEN_TIMES * (p->n_inputs + 1) *
                                          (AUDIT_PLACE_SIGNS + AUDIT_SIGN_TIMES * part->n_devices);
    for (watch->log2_screens = 2; (2 << watch->log2_screens) <= MOST_SCREENS &&
                                  (each << watch->log2_screens) <= MOST_NUMBERS;) {
        watch->log2_screens++;
    }
    struct audit_screen *screen =
        dalcs_arena_alloc(&audit->arena, (size_t)1 << watch->log2_screens, sizeof(*screen));
    watch->column =
        dalcs_arena_alloc(&audit->arena, 3 * (size_t)dalcs_quads_of(p->n_columns), sizeof(double));
    bool complete = screen != NULL && watch->column != NULL && draw_states(audit, part, watch);
    for (int k = 0; k <= AUDIT_N_ROWS && complete; k++) {
        complete = start_row(audit, &watch->row[k], p->n_columns);
    }
    find_barycentric(p, watch->barycentric);
    audit_screen_draw_times(audit, watch, p);
    watch->screen = complete ? screen : NULL;
    return complete;
}

void audit_screen_finish(struct audit_part *part) {
    struct audit_watch *watch = part->watch;
    for (int k = 0; watch != NULL && watch->screen != NULL && k < 1 << watch->log2_screens; k++) {
        free(watch->screen[k].row);
        free(watch->screen[k].image);
        free(watch->screen[k].sign);
        free(watch->screen[k].term);
    }
    if (watch != NULL) {
        free(watch->place);
    }
}

static bool make_room(struct audit_watch *watch, struct audit_screen *screen,
                      const struct dalcs_audit_polynomials *p) {
    const size_t rows = AUDIT_N_ROWS * (size_t)dalcs_quads_of(p->n_columns);
    screen->n_places = dalcs_quads_of(AUDIT_PLACE_SIGNS + AUDIT_SIGN_TIMES * screen->n_signs);
    return dalcs_grow(&screen->row, &screen->row_room, rows, sizeof(double)) == DALCS_OK &&
           dalcs_grow(&watch->place, &watch->place_room, (size_t)screen->n_places,
                      sizeof(double)) == DALCS_OK;
}

struct audit_screen *audit_screen_make(struct dalcs_audit *audit, struct audit_part *part,
                                       const struct dalcs_audit_polynomials *p,
                                       const struct dalcs_audit_state *s) {
    if (part->watch->screen == NULL && !start(audit, part, p)) {
        return NULL;
    }
    struct audit_screen *screen = slot_of(part->watch, p->key);
    if (screen->key != p->key) {
        screen->limit = 1.0;
        screen->alarms = 0;
        screen->key = p->key;
    }
    screen->rests = 0;
    screen->is_made = false;
    screen->n_inputs = 0;
    screen->step = p->step;
    screen->end = p->end;
    if (!audit_screen_fill(audit, part, screen, p->step, s) || !make_room(part->watch, screen, p)) {
        return NULL;
    }
    audit_screen_put_rows(part->watch, screen, dalcs_quads_of(p->n_columns));
    screen->is_made = true;
    return screen;
}

void audit_screen_see_step(const struct dalcs_audit *audit, const struct audit_part *part,
                           struct audit_screen *screen, const struct dalcs_audit_polynomials *p) {
    const bool is_same = p->step == screen->step && audit_is_same_end(p->end, screen->end);
    screen->step = p->step;
    screen->end = p->end;
    const size_t need = AUDIT_SCREEN_TIMES * (size_t)p->n_inputs * (size_t)screen->n_places;
    if (!is_same || p->n_inputs == 0 || part->watch->theta[0] > p->end ||
        audit_screen_has_image(screen, p) || need > MOST_NUMBERS ||
        dalcs_grow(&screen->image, &screen->image_room, need, sizeof(double)) != DALCS_OK) {
        return;
    }
    screen->n_inputs = p->n_inputs;
    screen->image_step = p->step;
    screen->image_end = p->end;
    memset(screen->image, 0, need * sizeof(double));
    audit_screen_compose(audit, part, screen, p);
}
