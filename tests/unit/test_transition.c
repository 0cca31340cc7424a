/* test_transition.c - what is remembered, what is not, and that other modes are never mistaken. */
#include "present.h"
#include "transition.h"

#include "run_tests.h"

enum { N_WORDS = 2 };

static uint64_t mode[N_WORDS];
static struct dalcs_component component;
static struct dalcs_radau_part part;

static void start(void) {
    component = (struct dalcs_component){.osnsp = {.n_words = N_WORDS, .mode = mode}};
    part = (struct dalcs_radau_part){
        .component = &component, .length.level = 10, .segment.rounding = 10.0};
    mode[0] = 0;
    mode[1] = 0;
    ck_assert_int_eq(dalcs_transition_setup(&part), DALCS_OK);
}

static bool guess(uint64_t first, uint64_t second) {
    mode[0] = first;
    mode[1] = second;
    return dalcs_transition_guess(&part);
}

static void learn(uint64_t first, uint64_t second, int level) {
    mode[0] = first;
    mode[1] = second;
    ck_assert_int_eq(dalcs_transition_learn(&part, level), DALCS_OK);
}

START_TEST(test_learns) {
    start();
    ck_assert(!guess(1, 2));
    ck_assert(mode[0] == 1 && mode[1] == 2 && part.length.level == 10);
    learn(5, 6, 17);
    part.length.level = 3;
    ck_assert(guess(1, 2));
    ck_assert(mode[0] == 5 && mode[1] == 6 && part.length.level == 17);
    dalcs_transition_refuse(&part);
    ck_assert(mode[0] == 1 && mode[1] == 2 && part.length.level == 3);
    dalcs_transition_known(&part)->span.length = 1.0;
    learn(5, 6, 16); /* the same */
    ck_assert_double_eq(dalcs_transition_known(&part)->span.length, 1.0);
    learn(7, 8, 4); /* something else this time */
    ck_assert_double_eq(dalcs_transition_known(&part)->span.length, 0.0);
    ck_assert(guess(1, 2));
    ck_assert(mode[0] == 7 && mode[1] == 8 && part.length.level == 4);
    ck_assert(!guess(1, 3));
    ck_assert(!guess(0, 2));
    dalcs_transition_finish(&part);
    dalcs_arena_finish(&part.arena);
}

END_TEST

static void hold(uint64_t first, uint64_t second) {
    mode[0] = first;
    mode[1] = second;
    dalcs_present_hold(&part);
}

/* Two modes held before the same pairs have the same sides: what follows is not the same. */
START_TEST(test_held) {
    start();
    hold(9, 0);
    ck_assert(!guess(1, 2));
    learn(5, 6, 17);
    hold(0, 9);
    ck_assert(!guess(1, 2));
    learn(7, 8, 4);
    hold(9, 0);
    ck_assert(guess(1, 2));
    ck_assert(mode[0] == 5 && mode[1] == 6 && part.length.level == 17);
    hold(0, 9);
    ck_assert(guess(1, 2));
    ck_assert(mode[0] == 7 && mode[1] == 8 && part.length.level == 4);
    dalcs_transition_finish(&part);
    dalcs_arena_finish(&part.arena);
}

END_TEST

/* More modes than places: the older ones go, none is taken for another. */
START_TEST(test_many) {
    enum { MANY = 1000 };

    int n_known = 0;
    start();
    for (uint64_t k = 0; k < MANY; k++) {
        (void)guess(k, k % 7);
        learn(3 * k, k, (int)k);
        ck_assert(guess(k, k % 7));
    }
    for (uint64_t k = 0; k < MANY; k++) {
        if (guess(k, k % 7)) {
            ck_assert(mode[0] == 3 * k && mode[1] == k && part.length.level == (int)k);
            n_known++;
        }
    }
    ck_assert_int_ge(n_known, 30);
    dalcs_transition_finish(&part);
    dalcs_arena_finish(&part.arena);
}

END_TEST

/* As many as there are, while the table is no more than the maps; without any it stays as it began. */
START_TEST(test_grows) {
    enum { MANY = 1000, AT_FIRST = 64 };

    start();
    for (int round = 0; round < 2; round++) {
        int n_known = 0;
        part.stages.cache.bytes = round == 0 ? 0 : (size_t)1 << 30;
        for (uint64_t k = 0; k < MANY; k++) {
            (void)guess(k, k % 7);
            learn(3 * k, k, (int)k);
        }
        for (uint64_t k = 0; k < MANY; k++) {
            bool is_known = guess(k, k % 7);
            ck_assert(!is_known || (mode[0] == 3 * k && part.length.level == (int)k));
            n_known += is_known ? 1 : 0;
        }
        ck_assert_int_eq(part.memory.n_transitions == AT_FIRST, round == 0);
        ck_assert_int_le(part.memory.n_transitions, 8 * MANY);
        ck_assert_int_eq(n_known == MANY, round == 1);
    }
    dalcs_transition_finish(&part);
    dalcs_arena_finish(&part.arena);
}

END_TEST

/* What has not been before begins with the length that suited the last pair that closed. */
START_TEST(test_beginning) {
    start();
    hold(0, 0);
    ck_assert(!guess(1, 0) && part.length.level == 10);
    part.length.level = 14; /* it had to be shorter */
    dalcs_transition_began(&part, 10, 0);
    hold(1, 0);
    part.length.level = 10;
    ck_assert(!guess(3, 0) && part.length.level == 14);
    dalcs_transition_refuse(&part);
    ck_assert_int_eq(part.length.level, 10);
    hold(3, 0);
    ck_assert(!guess(2, 0) && part.length.level == 10); /* one opens: something else */
    part.length.level = 16;
    hold(2, 0);
    ck_assert(!guess(2, 1) && part.length.level == 16); /* shorter anyhow */
    dalcs_transition_began(&part, 16, 5);
    part.length.level = 10;
    ck_assert(!guess(2, 3) && part.length.level == 14);
    dalcs_transition_began(&part, 14, 2); /* its error promises more */
    part.length.level = 10;
    ck_assert(!guess(2, 5) && part.length.level == 12);
    part.length.level = 10;
    part.segment.rounding = 1.0; /* on dense maps the circuit is asked */
    ck_assert(!guess(2, 7) && part.length.level == 10);
    dalcs_transition_finish(&part);
    dalcs_arena_finish(&part.arena);
}

END_TEST

/* After guesses of `patience` that held a longer step is tried; each that has to be taken back doubles it. */
START_TEST(test_patience) {
    start();
    hold(0, 0);
    ck_assert(!guess(1, 0));
    part.length.level = 14;
    dalcs_transition_began(&part, 10, 0);
    for (int patience = 1; patience <= 8; patience *= 2) {
        for (int k = 0; k < patience; k++) {
            part.length.level = 10;
            ck_assert(!guess(1, 0) && part.length.level == 14);
            dalcs_transition_began(&part, 14, 0);
        }
        part.length.level = 10;
        ck_assert(!guess(1, 0) && part.length.level == 13);
        part.length.level = 14;
        dalcs_transition_began(&part, 13, 0);
    }
    for (int k = 0; k < 16; k++) {
        part.length.level = 10;
        ck_assert(!guess(1, 0) && part.length.level == 14);
        dalcs_transition_began(&part, 14, 0);
    }
    for (int level = 13; level > 10; level--) { /* those that hold go on */
        part.length.level = 10;
        ck_assert(!guess(1, 0) && part.length.level == level);
        dalcs_transition_began(&part, level, 0);
    }
    dalcs_transition_finish(&part);
    dalcs_arena_finish(&part.arena);
}

END_TEST

RUN_TESTS("transition", test_learns, test_held, test_many, test_grows, test_beginning,
          test_patience)
