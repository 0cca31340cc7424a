/* guard_segment.h - one segment whose guards are looked at. */
#ifndef GUARD_SEGMENT_H
#define GUARD_SEGMENT_H

#include "build_network.h"
#include "guards.h"
#include "tied.h"

#include <string.h>

enum { MOST = 400 };

static struct text_network t;
static struct dalcs_osnsp osnsp;
static struct dalcs_component component;
static struct dalcs_excitation x;
static struct dalcs_radau r;
static struct dalcs_radau_part part;
static double out[MOST];
static double out_before[MOST];
static uint64_t modes_before[2];
static bool armed[8];
static int crossed[8];
static const double unit[2] = {1.0, 1.0};

/* Two diodes and a switch that closes above 0.75 V and opens below 0.25 V of a voltage of its own. */
static const char usual[] = "guards\nV1 a 0 1\nR1 a b 1\nD1 b c\nD2 b d\nR2 d 0 1\nC1 c 0 1\n"
                            "S1 c 0 b 0 sm\n.model sm SW(Vt=0.5 Vh=0.25)\n.tran 1 100\n";

/* The same, but the source's current is not known. */
static const char without_law[] = "guards\nV1 b 0 1\nD1 b c\nD2 b d\nR2 d 0 1\nC1 c 0 1\n"
                                  "S1 c 0 d 0 sm\n.model sm SW(Vt=0.5 Vh=0.25)\n.tran 1 100\n";

static inline void start_with(const char *netlist) {
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    build_good_network(&t, netlist);
    const struct dalcs_system *s = &t.network.system[0];
    ck_assert_int_eq(dalcs_osnsp_setup(&osnsp, s, &options), DALCS_OK);
    component = (struct dalcs_component){.system = s, .circuit = &t.circuit};
    component.osnsp = osnsp;
    r = (struct dalcs_radau){.options = {.stop = 100.0}, .resolution = 1e-13};
    part = (struct dalcs_radau_part){.component = &component,
                                     .inner_tolerance = 3e-8,
                                     .segment.h = 1.0,
                                     .segment.rounding = 1.0,
                                     .segment.out = out,
                                     .segment.out_before = out_before,
                                     .memory.modes_before = modes_before,
                                     .guards.armed = armed,
                                     .guards.crossed = crossed};
    ck_assert_int_eq(dalcs_excitation_setup(&x, &t.circuit, s, NULL), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&part.stages, s, &x,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, 5),
                                        &(struct dalcs_stage_limits){64, 1e-14, 1 << 20}),
                     DALCS_OK);
    ck_assert_int_eq(part.stages.n_watched, 1);
    ck_assert_int_eq(dalcs_step_setup(&part), DALCS_OK);
    ck_assert_int_eq(dalcs_guards_setup(&part), DALCS_OK);
    for (int k = 0; k < 8; k++) {
        armed[k] = false;
    }
    memset(out_before, 0, sizeof(out_before));
    modes_before[0] = component.osnsp.mode[0];
}

static inline void start(void) {
    start_with(usual);
}

static inline void finish(void) {
    dalcs_arena_finish(&part.arena);
    dalcs_stages_finish(&part.stages);
    dalcs_excitation_finish(&x);
    dalcs_osnsp_finish(&osnsp);
    text_network_finish(&t);
}

/* The straight line from `first` to `last` in the place of a pair, or of the watched voltage. */
static inline void draw(const char *name, double first, double last) {
    const struct dalcs_system *s = component.system;
    const struct dalcs_stage_layout *l = &part.stages.layout;
    int at =
        name != NULL ? dalcs_system_n_equations(s) + find_pair(s, name) : dalcs_system_n_columns(s);
    for (int k = 0; k < l->n_nodes; k++) {
        out[k * l->stride + at] = first + (last - first) * part.stages.method->node[k];
    }
}

static inline double first_fall(double end) {
    bool at_once;
    double theta = dalcs_guards_first_fall(&r, &part, end, unit, &at_once);
    ck_assert(!at_once);
    return theta;
}

/* Is there a fall, and is it one from the start? */
static inline bool falls_at_once(void) {
    bool at_once;
    ck_assert_double_eq(dalcs_guards_first_fall(&r, &part, 1.0, unit, &at_once), 0.0);
    return at_once;
}

static inline void arm(void) {
    dalcs_guards_arm(&part, false, unit);
}

/* One line for d1, all else far above 0. */
static inline void arm_beside(double first, double last) {
    draw("d1", first, last);
    draw("d2", 1.0, 1.0);
    draw(NULL, 0.5, 0.5);
    arm();
}

#endif
