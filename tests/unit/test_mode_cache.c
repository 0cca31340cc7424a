/* test_mode_cache.c - factors by (mode, sigma): found again, bounded, least recently used out first. */
#include "osnsp_internal.h"

#include "build_network.h"

static struct text_network t;
static struct dalcs_osnsp p;

/* Eight diodes, each from a source over its own resistor to a common one: every mode is regular. */
static void setup(size_t cache_bytes) {
    build_good_network(&t, "star\nV1 s 0 1\nR0 c 0 1\nC0 c 0 1u\n"
                           "R1 s a1 1\nD1 a1 c\nR2 s a2 2\nD2 a2 c\nR3 s a3 3\nD3 a3 c\n"
                           "R4 s a4 4\nD4 a4 c\nR5 s a5 5\nD5 a5 c\nR6 s a6 6\nD6 a6 c\n"
                           "R7 s a7 7\nD7 a7 c\nR8 s a8 8\nD8 a8 c\n.tran 1u 1m\n");
    struct dalcs_osnsp_options options = usual_osnsp_options();
    options.cache_bytes = cache_bytes;
    ck_assert_int_eq(dalcs_osnsp_setup(&p, &t.network.system[0], &options), DALCS_OK);
    ck_assert_int_eq(dalcs_forms_get(&p, 1e6), DALCS_OK);
}

static void finish(void) {
    dalcs_osnsp_finish(&p);
    text_network_finish(&t);
}

static struct dalcs_mode_entry *get(uint64_t mode, int kind) {
    struct dalcs_mode_entry *entry = NULL;
    p.mode[0] = mode;
    ck_assert_int_eq(dalcs_modes_get(&p, kind, &entry), DALCS_OK);
    ck_assert_ptr_nonnull(entry);
    ck_assert_ptr_eq(entry, p.cache.newest);
    return entry;
}

/* The list and the hash table hold the same entries, and their bytes are counted. */
static void check_books(void) {
    size_t bytes = 0;
    unsigned n = 0;
    for (const struct dalcs_mode_entry *e = p.cache.newest; e != NULL; e = e->older) {
        bytes += e->bytes;
        n++;
        ck_assert(e->older == NULL ? e == p.cache.oldest : e->older->newer == e);
    }
    ck_assert_uint_eq(bytes, p.cache.entry_bytes);
    ck_assert_uint_eq(n, HASH_COUNT(p.cache.entries));
}

START_TEST(test_recurring) {
    setup((size_t)1 << 30);
    for (int round = 0; round < 3; round++) {
        for (uint64_t mode = 0; mode < 256; mode++) {
            const struct dalcs_mode_entry *e = get(mode, DALCS_PLAIN);
            ck_assert(!e->singular);
            ck_assert_int_eq(e->n_on, __builtin_popcountll(mode));
            ck_assert_int_eq(e->lu.n, p.cache.form[0]->n + e->n_on);
        }
    }
    ck_assert_int_eq(p.counters.factorizations, 256);
    ck_assert_int_eq(p.counters.cache_hits, 512);
    /* Other weights or another step size are other matrices. */
    const struct dalcs_mode_entry *plain = get(3, DALCS_PLAIN);
    ck_assert_ptr_ne(get(3, 1), plain);
    ck_assert_ptr_ne(get(3, 2), plain);
    ck_assert_int_eq(dalcs_forms_get(&p, 2e6), DALCS_OK);
    ck_assert_ptr_ne(get(3, DALCS_PLAIN), plain);
    ck_assert_int_eq(p.counters.factorizations, 259);
    ck_assert_int_eq(dalcs_forms_get(&p, 1e6), DALCS_OK);
    ck_assert_ptr_eq(get(3, DALCS_PLAIN), plain);
    ck_assert_int_eq(p.counters.factorizations, 259);
    check_books();
    finish();
}

END_TEST

START_TEST(test_bounded) {
    setup((size_t)1 << 30);
    size_t largest = get(255, DALCS_PLAIN)->bytes;
    finish();
    setup(10 * largest);
    unsigned most = 0;
    for (uint64_t mode = 0; mode < 256; mode++) {
        get(mode, DALCS_PLAIN);
        ck_assert_uint_le(p.cache.entry_bytes, 10 * largest);
        most = HASH_COUNT(p.cache.entries) > most ? HASH_COUNT(p.cache.entries) : most;
        check_books();
    }
    ck_assert_uint_ge(most, 10);
    /* A map that is added to an entry counts, and makes room at the expense of others. */
    struct dalcs_mode_entry *e = get(255, DALCS_PLAIN);
    dalcs_modes_grew(&p, e, 4 * largest);
    ck_assert_uint_le(p.cache.entry_bytes, 10 * largest);
    ck_assert_ptr_eq(p.cache.newest, e);
    check_books();
    finish();
}

END_TEST

/* What is used stays, what is not goes. */
START_TEST(test_least_recently_used) {
    setup((size_t)1 << 30);
    size_t largest = get(255, DALCS_PLAIN)->bytes;
    finish();
    setup(8 * largest);
    get(1, DALCS_PLAIN);
    get(2, DALCS_PLAIN);
    for (uint64_t mode = 64; mode < 256; mode++) {
        long before = p.counters.factorizations;
        get(1, DALCS_PLAIN);
        ck_assert(mode == 64 || p.counters.factorizations == before);
        get(mode, DALCS_PLAIN);
    }
    long before = p.counters.factorizations;
    get(2, DALCS_PLAIN);
    ck_assert_int_eq(p.counters.factorizations, before + 1);
    finish();
}

END_TEST

/* However small the bound: the entries that one solve holds at a time stay valid. */
START_TEST(test_handful) {
    setup(1);
    struct dalcs_mode_entry *held = get(5, DALCS_PLAIN);
    get(5, 1);
    get(5, 2);
    get(5, 3);
    bool found = false;
    for (const struct dalcs_mode_entry *e = p.cache.newest; e != NULL; e = e->older) {
        found = found || e == held;
    }
    ck_assert(found);
    for (uint64_t mode = 0; mode < 100; mode++) {
        get(mode, DALCS_PLAIN);
        ck_assert_uint_le(HASH_COUNT(p.cache.entries), 4);
    }
    check_books();
    finish();
}

END_TEST

/* Step sizes are bounded too, and take their factors along. */
static void check_forms(size_t bytes, int most) {
    setup(bytes);
    for (int k = 1; k <= 3 * most; k++) {
        ck_assert_int_eq(dalcs_forms_get(&p, 1e3 * k), DALCS_OK);
        ck_assert_double_eq(p.cache.form[0]->sigma, 1e3 * k);
        get(1, DALCS_PLAIN);
        get(2, DALCS_PLAIN);
        ck_assert_int_le(p.cache.n_forms, most);
        ck_assert_uint_le(HASH_COUNT(p.cache.entries), 2 * (unsigned)most);
        /* The first of them is used throughout and stays. */
        const struct dalcs_step_form *first = NULL;
        ck_assert_int_eq(dalcs_forms_get(&p, 1e3), DALCS_OK);
        first = k == 1 ? p.cache.form[0] : first;
        long before = p.counters.factorizations;
        get(1, DALCS_PLAIN);
        ck_assert_int_eq(p.counters.factorizations, before);
        ck_assert(first == NULL || p.cache.form[0] == first);
    }
    ck_assert_int_eq(p.cache.n_forms, most);
    check_books();
    finish();
}

START_TEST(test_forms) {
    check_forms((size_t)1 << 30, DALCS_MOST_FORMS);
}

END_TEST

/* Beyond the cache's bytes a few stay: forms are of what a step always needs. */
START_TEST(test_few_forms) {
    check_forms(1, 32);
}

END_TEST

RUN_TESTS("mode_cache", test_recurring, test_bounded, test_least_recently_used, test_handful,
          test_forms, test_few_forms)
