/* test_stage_updates.c - when the factors of a mode are an update of those of another one, and when no longer. */
#include "stage_comparison.h"

#include <math.h>
#include <stdio.h>

/* An update keeps the factors that it uses, and all bytes are accounted for. */
START_TEST(test_base_is_evicted) {
    struct three_stages b;
    struct tally tally = {0};
    uint64_t random = 5;
    setup_stages(&b,
                 "peak detectors\n"
                 "v1 n0 0 sin(0 10 1k)\n"
                 "r1 n0 n1 1\nc1 n1 0 10n\nd1 n1 p1 di\ncp1 p1 0 10n\nrp1 p1 0 1meg\n"
                 "r2 n1 n2 1\nc2 n2 0 10n\nd2 n2 p2 di\ncp2 p2 0 10n\nrp2 p2 0 1meg\n"
                 ".model di d\n.tran 1u 1m uic\n.end\n",
                 5, false);
    const uint64_t open = 0;
    const uint64_t first = 1;
    const double h = 1e-6;
    struct dalcs_stage_entry *base;
    struct dalcs_stage_entry *update;
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &open, h, &base), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &first, h, &update), DALCS_OK);
    ck_assert(dalcs_stage_is_update(update));
    ck_assert_ptr_eq(update->factors->update->base, base);
    ck_assert_int_eq(b.updated.cache.factorizations, 1);
    ck_assert_uint_eq(b.updated.cache.bytes, base->bytes + update->bytes);
    b.updated.cache.most_bytes = 1; /* the next one is alone, with what it cannot do without */
    for (uint64_t mode = 2; mode <= 3; mode++) {
        check_mode(&b, &mode, h, &random, &tally);
        ck_assert(!dalcs_stages_find(&b.updated, &open, h));
        ck_assert(!dalcs_stages_find(&b.updated, &first, h));
        ck_assert_uint_eq(b.updated.cache.bytes, base->bytes + b.updated.cache.newest->bytes);
    }
    check_mode(&b, &open, h, &random, &tally); /* nothing changes */
    ck_assert_int_eq(b.updated.cache.factorizations, 1);
    check_mode(&b, &open, 2.0 * h, &random, &tally);
    ck_assert_int_eq(b.updated.cache.factorizations, 2);
    ck_assert_uint_eq(b.updated.cache.bytes, b.updated.cache.newest->bytes);
    finish_stages(&b);
    ck_assert_int_eq(tally.n_closings, 3);
}

END_TEST

static const char *const peak_detector =
    "peak detector\nv1 n0 0 sin(0 10 1k)\nr1 n0 n1 1\nc1 n1 0 10n\n"
    "d1 n1 p1 di\ncp1 p1 0 10n\nrp1 p1 0 1meg\n.model di d\n.tran 1u 1m uic\n.end\n";

/* Where an update is used again and again, factors of its own are cheaper. */
START_TEST(test_update_is_spent) {
    struct three_stages b;
    setup_stages(&b, peak_detector, 3, false);
    struct dalcs_stage_entry *entry;
    int n_steps = 0;
    for (uint64_t mode = 0; mode < 2; mode++) {
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &mode, 1e-6, &entry), DALCS_OK);
    }
    ck_assert(dalcs_stage_is_update(entry));
    for (uint64_t mode = 1; dalcs_stage_is_update(entry); n_steps++) {
        ck_assert_int_lt(n_steps, 10000);
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &mode, 1e-6, &entry), DALCS_OK);
    }
    ck_assert_int_gt(n_steps, 10);
    ck_assert_int_eq(b.updated.cache.factorizations, 2);
    ck_assert_int_eq(HASH_COUNT(b.updated.cache.entries), 2);
    finish_stages(&b);
}

END_TEST

/* A step that misses its equations is not believed: the mode gets factors of its own. */
START_TEST(test_update_is_doubtful) {
    struct three_stages b;
    setup_stages(&b, peak_detector, 3, false);
    struct dalcs_stage_entry *entry;
    struct tally tally = {0};
    uint64_t random = 7;
    for (uint64_t mode = 0; mode < 2; mode++) {
        check_mode(&b, &mode, 1e-6, &random, &tally);
    }
    const uint64_t closed = 1;
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &closed, 1e-6, &entry), DALCS_OK);
    ck_assert(dalcs_stage_is_update(entry));
    ck_assert_int_eq(b.updated.cache.factorizations, 1);
    entry->factors->update->inverse[0][0] *= 1.0L + 1e-9L;
    entry->factors->update->inverse[1][0] *= 1.0L + 1e-9L;
    struct dalcs_stage_entry *dense;
    ck_assert_int_eq(dalcs_stages_get(&b.dense, &closed, 1e-6, &dense), DALCS_OK);
    check_steps(&b, &b.updated, &closed, 1e-6, dense, &random, &tally);
    ck_assert_int_eq(b.updated.cache.factorizations, 2);
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &closed, 1e-6, &entry), DALCS_OK);
    ck_assert(!dalcs_stage_is_update(entry));
    finish_stages(&b);
}

END_TEST

/* In a long chain of capacitors that diodes tie together a voltage that opens is small beside what it makes of
 * currents: digits cancel, which only some can spare. */
START_TEST(test_unseen_rounding) {
    char netlist[1 << 13];
    int length = sprintf(netlist, "multiplier\nv1 a0 0 sin(0 100 50k)\nr0 b0 0 1m\n");
    for (int k = 0; k < 30; k++) {
        length += sprintf(netlist + length,
                          "ca%d a%d a%d 1u\nda%d b%d a%d\ncb%d b%d b%d 1u\ndb%d a%d b%d\n", k, k,
                          k + 1, k, k, k + 1, k, k, k + 1, k, k + 1, k + 1);
    }
    sprintf(netlist + length, "rl b30 0 10meg\n.tran 1u 1m uic\n.end\n");
    struct three_stages b;
    setup_stages(&b, netlist, 5, false);
    const uint64_t closed = (UINT64_C(1) << 60) - 1;
    const uint64_t first_open = closed - 2;
    const double h = 5e-7;
    for (int spared = 0; spared < 2; spared++) {
        struct dalcs_stage_entry *entry;
        b.updated.unseen = spared ? 3e-13 : 0.0;
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &closed, spared ? 2.0 * h : h, &entry),
                         DALCS_OK);
        ck_assert(!dalcs_stage_is_update(entry));
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &first_open, spared ? 2.0 * h : h, &entry),
                         DALCS_OK);
        ck_assert(dalcs_stage_is_update(entry) == (spared == 1));
    }
    struct tally tally = {0};
    uint64_t random = 11;
    check_mode(&b, &first_open, 2.0 * h, &random, &tally);
    ck_assert_int_eq(tally.n_openings, 1);
    struct dalcs_stage_entry *update;
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &first_open, 2.0 * h, &update), DALCS_OK);
    b.updated.unseen = 1e-9; /* residuals are reported: they are to be rounding */
    update->residual = 5e-14;
    ck_assert(!dalcs_stage_update_is_doubtful(&b.updated, update));
    update->residual = 2e-13;
    ck_assert(dalcs_stage_update_is_doubtful(&b.updated, update));
    finish_stages(&b);
}

END_TEST

RUN_TESTS("stage updates", test_unseen_rounding, test_update_is_doubtful, test_base_is_evicted,
          test_update_is_spent)
