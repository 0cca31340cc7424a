/* transition.c - a table, the place of an entry being the hash of the modes before.
 *
 * It begins small, for most circuits have a few modes, and doubles where a place and its neighbours are all taken, as
 * long as it is no more than the maps that its modes lead to. A bridge of six switches with their diodes and a
 * rectifier behind it has thousands of transitions, which come back in every period of the modulation.
 */
#include "transition.h"

#include <limits.h>

/* An entry has three modes: the one that held, the one after pairs changed sides, what followed. */
enum { MODES = 3 };

/* At first, and places in which an entry may be. */
enum { SLOTS = 64, NEIGHBOURS = 8 };

/* A length that held is begun with so many times at most before a longer one is tried. */
enum { MOST_PATIENCE = 64 };

static size_t bytes_of(const struct dalcs_radau_part *part, size_t n_slots) {
    size_t modes = MODES * (size_t)part->component->osnsp.n_words * sizeof(uint64_t);
    return n_slots * (sizeof(*part->memory.transition) + modes);
}

static enum dalcs_status make_table(struct dalcs_radau_part *part, int n_slots) {
    size_t n_words = MODES * (size_t)n_slots * (size_t)part->component->osnsp.n_words;
    struct dalcs_transition *table =
        dalcs_arena_alloc(&part->arena, (size_t)n_slots, sizeof(*part->memory.transition));
    uint64_t *modes = dalcs_arena_alloc(&part->arena, n_words, sizeof(*modes));
    if (table == NULL || modes == NULL) {
        return DALCS_E_NOMEM;
    }
    part->memory.transition = table;
    part->memory.transition_modes = modes;
    part->memory.n_transitions = n_slots;
    return DALCS_OK;
}

enum dalcs_status dalcs_transition_setup(struct dalcs_radau_part *part) {
    size_t words = (size_t)part->component->osnsp.n_words;
    DALCS_TRY(make_table(part, SLOTS));
    part->memory.modes_before = dalcs_arena_alloc(&part->arena, 2 * words, sizeof(uint64_t));
    part->work.mode_tied = dalcs_arena_alloc(&part->arena, words, sizeof(uint64_t));
    part->work.mode_turned = dalcs_arena_alloc(&part->arena, words, sizeof(uint64_t));
    part->work.mode_longer = dalcs_arena_alloc(&part->arena, words, sizeof(uint64_t));
    part->work.mode_before = dalcs_arena_alloc(&part->arena, words, sizeof(uint64_t));
    part->work.mode_first = dalcs_arena_alloc(&part->arena, words, sizeof(uint64_t));
    part->memory.beginning[0] = part->memory.beginning[1] = (struct dalcs_beginning){INT_MIN, 0, 1};
    bool complete = part->memory.modes_before != NULL && part->work.mode_tied != NULL &&
                    part->work.mode_turned != NULL && part->work.mode_longer != NULL &&
                    part->work.mode_first != NULL && part->work.mode_before != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_transition_finish(struct dalcs_radau_part *part) {
    for (int k = 0; k < part->memory.n_transitions; k++) {
        if (part->memory.transition[k].is_known) {
            dalcs_transition_count(part, &part->memory.transition[k].span, 0.0);
            dalcs_transition_count(part, &part->memory.transition[k].step, 0.0);
        }
    }
}

struct dalcs_transition *dalcs_transition_known(const struct dalcs_radau_part *part) {
    return &part->memory.transition[part->memory.present_transition];
}

void dalcs_transition_count(struct dalcs_radau_part *part, struct dalcs_recurring *recurring,
                            double length) {
    dalcs_stage_brief_destroy(&part->stages, recurring->brief);
    recurring->brief = NULL;
    recurring->length = length;
    recurring->times = 0;
}

static uint64_t *modes_in(const struct dalcs_radau_part *part, size_t slot) {
    return part->memory.transition_modes + slot * MODES * (size_t)part->component->osnsp.n_words;
}

/* Of the mode that held and the one after pairs changed sides: where it is, or else an empty place for it; where there is
 * none, its first. */
static size_t find_slot(const struct dalcs_radau_part *part, const uint64_t *before) {
    int n_words = 2 * part->component->osnsp.n_words;
    size_t n_slots = (size_t)part->memory.n_transitions;
    uint64_t hash = 14695981039346656037u;
    for (int k = 0; k < n_words; k++) {
        hash = (hash ^ before[k]) * 1099511628211u;
        hash ^= hash >> 29;
    }
    for (size_t k = 0; k < NEIGHBOURS; k++) {
        size_t slot = (size_t)(hash + k) % n_slots;
        if (!part->memory.transition[slot].is_known ||
            dalcs_mode_is(modes_in(part, slot), before, n_words)) {
            return slot;
        }
    }
    return (size_t)hash % n_slots;
}

/* Modes are a word or two, which calls would cost more than. */
static void copy_mode(uint64_t *to, const uint64_t *from, size_t words) {
    for (size_t k = 0; k < words; k++) {
        to[k] = from[k];
    }
}

/* What a pair joins has to become equal, often fast; one that opens only lets go. */
static struct dalcs_beginning *find_beginning(struct dalcs_radau_part *part) {
    int n_words = part->component->osnsp.n_words;
    uint64_t closed = 0;
    for (int k = 0; k < n_words; k++) {
        closed |= part->memory.modes_before[n_words + k] & ~part->memory.modes_before[k];
    }
    return &part->memory.beginning[closed != 0];
}

bool dalcs_transition_guess(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    size_t words = (size_t)p->n_words;
    copy_mode(part->memory.modes_before + words, p->mode, words);
    size_t slot = find_slot(part, part->memory.modes_before);
    part->memory.present_transition = (int)slot;
    const uint64_t *known = modes_in(part, slot);
    part->length.level_before = part->length.level;
    if (!part->memory.transition[slot].is_known ||
        !dalcs_mode_is(known, part->memory.modes_before, 2 * p->n_words)) {
        /* On dense maps a one-step problem costs little, and decides more than a short step. */
        int level = find_beginning(part)->level;
        if (part->segment.rounding > 1.0 && level > part->length.level) {
            part->length.level = level;
        }
        return false;
    }
    copy_mode(p->mode, known + 2 * words, words);
    part->length.level = dalcs_transition_known(part)->level;
    return true;
}

int dalcs_transition_longest_level(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const uint64_t *followed = part->memory.transition_modes + 2 * p->n_words;
    int level = part->length.level;
    for (int k = 0; k < part->memory.n_transitions; k++, followed += MODES * p->n_words) {
        const struct dalcs_transition *t = &part->memory.transition[k];
        if (t->is_known && t->level < level && dalcs_mode_is(followed, p->mode, p->n_words)) {
            level = t->level;
        }
    }
    return level;
}

void dalcs_transition_pass(struct dalcs_radau_part *part, int spare) {
    dalcs_transition_known(part)->level = part->length.level - spare;
}

void dalcs_transition_refuse(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    copy_mode(p->mode, part->memory.modes_before + p->n_words, (size_t)p->n_words);
    part->length.level = part->length.level_before;
}

void dalcs_transition_began(struct dalcs_radau_part *part, int tried, int promised) {
    struct dalcs_beginning *b = find_beginning(part);
    if (part->length.level > tried) {
        bool in_vain = b->level == tried && b->patience < MOST_PATIENCE;
        *b = (struct dalcs_beginning){part->length.level, 0,
                                      in_vain ? 2 * b->patience : b->patience};
    } else if (b->level == tried) {
        b->waited += b->waited < b->patience ? 1 : 0;
        b->level -= promised > 0 ? promised : b->waited == b->patience ? 1 : 0;
    }
}

/* Has the place of what is to be learned another transition? */
static bool is_taken(const struct dalcs_radau_part *part) {
    size_t slot = (size_t)part->memory.present_transition;
    return part->memory.transition[slot].is_known &&
           !dalcs_mode_is(modes_in(part, slot), part->memory.modes_before,
                          2 * part->component->osnsp.n_words);
}

/* All find places in a table twice as large, for those of any two neighbourhoods here are no fewer there. */
static enum dalcs_status grow(struct dalcs_radau_part *part) {
    size_t words = MODES * (size_t)part->component->osnsp.n_words;
    const struct dalcs_transition *table = part->memory.transition;
    const uint64_t *modes = part->memory.transition_modes;
    int n = part->memory.n_transitions;
    DALCS_TRY(make_table(part, 2 * n));
    for (int k = 0; k < n; k++, modes += words) {
        if (table[k].is_known) {
            size_t slot = find_slot(part, modes);
            part->memory.transition[slot] = table[k];
            copy_mode(modes_in(part, slot), modes, words);
        }
    }
    part->memory.present_transition = (int)find_slot(part, part->memory.modes_before);
    return DALCS_OK;
}

enum dalcs_status dalcs_transition_learn(struct dalcs_radau_part *part, int level) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    size_t words = (size_t)p->n_words;
    while (is_taken(part) &&
           bytes_of(part, 2 * (size_t)part->memory.n_transitions) <= part->stages.cache.bytes) {
        DALCS_TRY(grow(part));
    }
    uint64_t *modes = modes_in(part, (size_t)part->memory.present_transition);
    struct dalcs_transition *known = dalcs_transition_known(part);
    bool is_same = known->is_known &&
                   dalcs_mode_is(modes, part->memory.modes_before, 2 * p->n_words) &&
                   dalcs_mode_is(modes + 2 * words, p->mode, p->n_words);
    known->level = level;
    if (!is_same) {
        known->is_known = true;
        copy_mode(modes, part->memory.modes_before, 2 * words);
        copy_mode(modes + 2 * words, p->mode, words);
        dalcs_transition_count(part, &known->span, 0.0);
        dalcs_transition_count(part, &known->step, 0.0);
    }
    return DALCS_OK;
}
