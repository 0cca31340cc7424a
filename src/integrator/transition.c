/* transition.c - a small table, the place of an entry being the hash of the mode before. */
#include "transition.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS = 64 };

enum dalcs_status dalcs_transition_setup(struct dalcs_radau_part *part) {
    size_t words = (size_t)part->component->osnsp.n_words;
    part->transition = dalcs_alloc(SLOTS, sizeof(*part->transition));
    part->transition_modes = dalcs_alloc(SLOTS * 2 * words, sizeof(uint64_t));
    part->mode_before = dalcs_alloc(words, sizeof(uint64_t));
    part->mode_tied = dalcs_alloc(words, sizeof(uint64_t));
    bool complete = part->transition != NULL && part->transition_modes != NULL &&
                    part->mode_before != NULL && part->mode_tied != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_transition_finish(struct dalcs_radau_part *part) {
    free(part->transition);
    free(part->transition_modes);
    free(part->mode_before);
    free(part->mode_tied);
}

static size_t slot_of(const struct dalcs_radau_part *part, const uint64_t *mode) {
    uint64_t hash = 14695981039346656037u;
    for (int k = 0; k < part->component->osnsp.n_words; k++) {
        hash = (hash ^ mode[k]) * 1099511628211u;
        hash ^= hash >> 29;
    }
    return (size_t)(hash % SLOTS);
}

bool dalcs_transition_guess(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    size_t words = (size_t)p->n_words;
    memcpy(part->mode_before, p->mode, words * sizeof(uint64_t));
    part->level_before = part->level;
    size_t slot = slot_of(part, p->mode);
    const uint64_t *known = part->transition_modes + slot * 2 * words;
    if (!part->transition[slot].is_known || memcmp(known, p->mode, words * sizeof(uint64_t)) != 0) {
        return false;
    }
    memcpy(p->mode, known + words, words * sizeof(uint64_t));
    part->level = part->transition[slot].level;
    return true;
}

void dalcs_transition_refuse(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(p->mode, part->mode_before, (size_t)p->n_words * sizeof(uint64_t));
    part->level = part->level_before;
}

void dalcs_transition_learn(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    size_t words = (size_t)p->n_words;
    size_t slot = slot_of(part, part->mode_before);
    memcpy(part->transition_modes + slot * 2 * words, part->mode_before, words * sizeof(uint64_t));
    memcpy(part->transition_modes + (slot * 2 + 1) * words, p->mode, words * sizeof(uint64_t));
    part->transition[slot].is_known = true;
    part->transition[slot].level = part->level;
}
