/* transition.c - a small table of modes, the place of an entry being its hash. */
#include "transition.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS = 64 };

enum dalcs_status dalcs_transition_setup(struct dalcs_radau_part *part) {
    size_t words = (size_t)part->component->osnsp.n_words;
    part->transitions = dalcs_alloc(SLOTS * 2 * words, sizeof(uint64_t));
    part->transition_known = dalcs_alloc(SLOTS, sizeof(bool));
    part->mode_before = dalcs_alloc(words, sizeof(uint64_t));
    bool complete =
        part->transitions != NULL && part->transition_known != NULL && part->mode_before != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

static size_t slot_of(const struct dalcs_radau_part *part, const uint64_t *mode) {
    uint64_t hash = 14695981039346656037u;
    for (int k = 0; k < part->component->osnsp.n_words; k++) {
        hash = (hash ^ mode[k]) * 1099511628211u;
        hash ^= hash >> 29;
    }
    return (size_t)(hash % SLOTS);
}

bool dalcs_transition_guess(struct dalcs_radau_part *part, bool flipped) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    size_t words = (size_t)p->n_words;
    memcpy(part->mode_before, p->mode, words * sizeof(uint64_t));
    size_t slot = slot_of(part, p->mode);
    const uint64_t *known = part->transitions + slot * 2 * words;
    if (!flipped || !part->transition_known[slot] ||
        memcmp(known, p->mode, words * sizeof(uint64_t)) != 0) {
        return false;
    }
    memcpy(p->mode, known + words, words * sizeof(uint64_t));
    return true;
}

void dalcs_transition_refuse(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(p->mode, part->mode_before, (size_t)p->n_words * sizeof(uint64_t));
}

void dalcs_transition_learn(struct dalcs_radau_part *part, bool found_by_restart) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    size_t words = (size_t)p->n_words;
    if (!found_by_restart || !part->flipped || words == 0) {
        return;
    }
    size_t slot = slot_of(part, part->mode_before);
    memcpy(part->transitions + slot * 2 * words, part->mode_before, words * sizeof(uint64_t));
    memcpy(part->transitions + (slot * 2 + 1) * words, p->mode, words * sizeof(uint64_t));
    part->transition_known[slot] = true;
}
