/* test_names.c - the table of names and the search for a mistyped one. */
#include "names.h"

#include "run_tests.h"

#include <stdio.h>

START_TEST(test_many) {
    enum { N = 20000 };
    struct dalcs_names names = {0};
    struct dalcs_arena arena = {0};
    ck_assert_int_eq(dalcs_names_find(&names, "n1"), -1);
    for (int k = 0; k < N; k++) {
        const char *name = dalcs_arena_printf(&arena, "n%d", k);
        ck_assert_int_eq(dalcs_names_add(&names, name, 3 * k), DALCS_OK);
    }
    char name[32];
    for (int k = 0; k < N; k++) {
        snprintf(name, sizeof name, "n%d", k);
        ck_assert_int_eq(dalcs_names_find(&names, name), 3 * k);
        snprintf(name, sizeof name, "m%d", k);
        ck_assert_int_eq(dalcs_names_find(&names, name), -1);
    }
    ck_assert_int_eq(dalcs_names_find(&names, ""), -1);
    ck_assert_ptr_null(dalcs_names_join(&names, 8, &arena));
    dalcs_names_finish(&names);
    dalcs_names_finish(&names);
    dalcs_arena_finish(&arena);
}

END_TEST

START_TEST(test_nearest) {
    static const char *const known[] = {"reltol", "abstol", "vntol", "ron", "roff", "in", "out"};

    enum { N = sizeof known / sizeof known[0] };

    static const struct {
        const char *name;
        const char *nearest;
    } wanted[] = {
        {"retol", "reltol"},                    /* a letter missing */
        {"relltol", "reltol"},                  /* one too many */
        {"reltoi", "reltol"},                   /* changed */
        {"erltol", "reltol"},                   /* swapped */
        {"rletol", "reltol"},  {"rof", "roff"}, /* as near to ron; the longer common start wins */
        {"rom", "ron"},        {"ou", "out"},    {"abtsol", "abstol"},
        {"abxxol", "abstol"},  {"abxxxl", NULL}, /* three letters: a guess */
        {"im", NULL},                            /* half of a name */
        {"a", NULL},           {"", NULL},       {"something else altogether", NULL},
    };

    for (size_t k = 0; k < sizeof wanted / sizeof wanted[0]; k++) {
        const char *nearest = dalcs_names_nearest_of(known, N, wanted[k].name);
        if (wanted[k].nearest == NULL) {
            ck_assert_msg(nearest == NULL, "%s: %s", wanted[k].name, nearest);
        } else {
            ck_assert_ptr_nonnull(nearest);
            ck_assert_str_eq(nearest, wanted[k].nearest);
        }
    }
}

END_TEST

START_TEST(test_table_of_few) {
    struct dalcs_names names = {0};
    struct dalcs_arena arena = {0};
    ck_assert_ptr_null(dalcs_names_join(&names, 8, &arena));
    ck_assert_int_eq(dalcs_names_add(&names, "v1", 0), DALCS_OK);
    ck_assert_str_eq(dalcs_names_join(&names, 8, &arena), "v1");
    ck_assert_int_eq(dalcs_names_add(&names, "rload", 1), DALCS_OK);
    ck_assert_str_eq(dalcs_names_join(&names, 2, &arena), "v1, rload");
    ck_assert_ptr_null(dalcs_names_join(&names, 1, &arena));
    ck_assert_str_eq(dalcs_names_nearest(&names, "rlaod"), "rload");
    ck_assert_ptr_null(dalcs_names_nearest(&names, "c9"));
    dalcs_names_finish(&names);
    dalcs_arena_finish(&arena);
}

END_TEST

RUN_TESTS("names", test_many, test_nearest, test_table_of_few)
