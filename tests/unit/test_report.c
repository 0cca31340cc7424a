/* test_report.c - the report's keys, numbers and escapes, byte by byte. */
#include "report.h"
#include "sample_plot.h"

#include <math.h>
#include <string.h>

static const char *const state_name[] = {"c1", "l1"};
static const double start[] = {4.0, -0.1}, final[] = {NAN, -INFINITY};
static const struct dalcs_event event[] = {{0.005, "d1", true}, {0.25, "s1", false}};
static const struct dalcs_jump_state jump_state[] = {{"c1", 10.0, 4.0}};
static const struct dalcs_impulse impulse[] = {{"d1", false, 6e-6}, {"d2", true, 0.001}};
static const struct dalcs_jump jump[] = {{0.0, 1, jump_state, 2, impulse, 24e-6, 0.25}};
static const struct dalcs_measurement measurement[] = {
    {.name = "mean",
     .found = true,
     .value = 0.5,
     .n_details = 2,
     .detail = {{"from", 0.0}, {"to", 2.0}}},
    {.name = "late", .failure = "never"},
};
static const struct dalcs_nonunique nonunique[] = {
    {"i(d1)", 0.25, 0.0, INFINITY, 0.5, "d1 parallel to d2"}};
static const char *const element[] = {"v1", "d1"};
static const struct dalcs_component_method component[] = {{"radau", 5, "tolerance 1e-06"},
                                                          {"algebraic", 1, "no state"}};

static void check_report(const struct dalcs_report *report, enum dalcs_status status,
                         const char *expected) {
    FILE *stream = fopen("report.json", "wb");
    ck_assert_ptr_nonnull(stream);
    dalcs_report_write(stream, report, status);
    ck_assert_int_eq(fclose(stream), 0);
    check_contents("report.json", expected);
}

START_TEST(test_everything) {
    const struct dalcs_report report = {
        .netlist = "a \"b\".cir",
        .title = "caf\303\251 \\ \377\tend",
        .method = "auto",
        .tolerance = 1e-6,
        .n_components = 2,
        .component = component,
        .step = 1e-6,
        .stop = 0.5,
        .size = {1, 2, 3, 4, 5, 2, 0},
        .work = {11, 12, 13, 14, 10, 9, 15, 16, 17, 18, 19, 0.5, 0.75},
        .certificate = {1e-15, 0.125, "KCL at out", 0.0625},
        .n_states = 2,
        .state_name = state_name,
        .start = start,
        .final = final,
        .n_events = 2,
        .event = event,
        .n_events_dropped = 7,
        .n_jumps = 1,
        .jump = jump,
        .n_nonunique = 1,
        .nonunique = nonunique,
        .n_measurements = 2,
        .measurement = measurement,
        .energy = {true, 4.0, 2.0, 1.0, 0.25, 0.5, 0.125, 0.125},
        .infeasible = {true, 0.5, "loop", 2, element, "v1 drives d1"},
    };
    check_report(&report, DALCS_INFEASIBLE,
                 "{\n"
                 "  \"netlist\": \"a \\\"b\\\".cir\",\n"
                 "  \"title\": \"caf\303\251 \\\\ \\ufffd\\u0009end\",\n"
                 "  \"status\": \"the one-step problem has no solution\",\n"
                 "  \"method\": {\n"
                 "    \"component 1\": \"radau, 5 stages\",\n"
                 "    \"component 2\": \"algebraic\"\n"
                 "  },\n"
                 "  \"tolerance\": 1e-06,\n"
                 "  \"step\": 1e-06,\n"
                 "  \"stop\": 0.5,\n"
                 "  \"size\": {\"nodes\": 1, \"x\": 2, \"z\": 3, \"lambda\": 4, \"switches\": 5, "
                 "\"components\": 2},\n"
                 "  \"work\": {\n"
                 "    \"steps\": 11,\n"
                 "    \"rejected\": 12,\n"
                 "    \"restarts\": 13,\n"
                 "    \"euler_steps\": 14,\n"
                 "    \"periodic_steps\": 10,\n"
                 "    \"leapt_steps\": 9,\n"
                 "    \"osnsp\": 15,\n"
                 "    \"pivots\": 16,\n"
                 "    \"factorizations\": 17,\n"
                 "    \"cache_hits\": 18,\n"
                 "    \"singular\": 19,\n"
                 "    \"cpu_s\": 0.5,\n"
                 "    \"wall_s\": 0.75\n"
                 "  },\n"
                 "  \"certificate\": {\"worst\": 1e-15, \"time\": 0.125, "
                 "\"where\": \"KCL at out\", \"wrong_sign\": 0.0625},\n"
                 "  \"start\": {\n"
                 "    \"c1\": 4,\n"
                 "    \"l1\": -0.1\n"
                 "  },\n"
                 "  \"final\": {\n"
                 "    \"c1\": \"nan\",\n"
                 "    \"l1\": \"-inf\"\n"
                 "  },\n"
                 "  \"events\": [\n"
                 "    {\"time\": 0.005, \"element\": \"d1\", \"state\": \"on\"},\n"
                 "    {\"time\": 0.25, \"element\": \"s1\", \"state\": \"off\"}\n"
                 "  ],\n"
                 "  \"events_dropped\": 7,\n"
                 "  \"jumps\": [\n"
                 "    {\n"
                 "      \"time\": 0,\n"
                 "      \"states\": {\n"
                 "        \"c1\": {\"before\": 10, \"after\": 4}\n"
                 "      },\n"
                 "      \"impulses\": {\n"
                 "        \"d1\": {\"charge\": 6e-06},\n"
                 "        \"d2\": {\"flux\": 0.001}\n"
                 "      },\n"
                 "      \"energy_lost\": 2.4e-05,\n"
                 "      \"source_work\": 0.25\n"
                 "    }\n"
                 "  ],\n"
                 "  \"nonunique\": [\n"
                 "    {\n"
                 "      \"signal\": \"i(d1)\",\n"
                 "      \"lower\": 0,\n"
                 "      \"upper\": \"inf\",\n"
                 "      \"value\": 0.5,\n"
                 "      \"time\": 0.25,\n"
                 "      \"because\": \"d1 parallel to d2\"\n"
                 "    }\n"
                 "  ],\n"
                 "  \"measurements\": [\n"
                 "    {\"name\": \"mean\", \"value\": 0.5, \"from\": 0, \"to\": 2},\n"
                 "    {\"name\": \"late\", \"value\": null, \"failure\": \"never\"}\n"
                 "  ],\n"
                 "  \"energy\": {\n"
                 "    \"sources\": 4,\n"
                 "    \"resistors\": 2,\n"
                 "    \"diodes\": 1,\n"
                 "    \"jumps\": 0.25,\n"
                 "    \"stored_change\": 0.5,\n"
                 "    \"method\": 0.125,\n"
                 "    \"balance\": 0.125\n"
                 "  },\n"
                 "  \"infeasible\": {\n"
                 "    \"time\": 0.5,\n"
                 "    \"elements\": [\"v1\", \"d1\"],\n"
                 "    \"kind\": \"loop\",\n"
                 "    \"because\": \"v1 drives d1\"\n"
                 "  }\n"
                 "}\n");
}

END_TEST

/* Without .tran no method was chosen: the one asked for stands. */
START_TEST(test_method_without_transient) {
    const struct dalcs_report report = {.method = "auto", .size.components = 1};
    FILE *stream = fopen("report.json", "w+b");
    ck_assert_ptr_nonnull(stream);
    dalcs_report_write(stream, &report, DALCS_OK);
    char text[200] = "";
    rewind(stream);
    ck_assert_uint_gt(fread(text, 1, sizeof text - 1, stream), 0);
    ck_assert_int_eq(fclose(stream), 0);
    ck_assert_ptr_nonnull(strstr(text, "\"method\": {\n    \"component 1\": \"auto\"\n  }"));
}

END_TEST

/* A run that failed before it knew anything. */
START_TEST(test_nothing) {
    const struct dalcs_report report = {.method = "euler"};
    check_report(&report, DALCS_OK,
                 "{\n"
                 "  \"netlist\": null,\n"
                 "  \"title\": null,\n"
                 "  \"status\": \"ok\",\n"
                 "  \"method\": {},\n"
                 "  \"tolerance\": 0,\n"
                 "  \"step\": 0,\n"
                 "  \"stop\": 0,\n"
                 "  \"size\": {\"nodes\": 0, \"x\": 0, \"z\": 0, \"lambda\": 0, \"switches\": 0, "
                 "\"components\": 0},\n"
                 "  \"work\": {\n"
                 "    \"steps\": 0,\n"
                 "    \"rejected\": 0,\n"
                 "    \"restarts\": 0,\n"
                 "    \"euler_steps\": 0,\n"
                 "    \"periodic_steps\": 0,\n"
                 "    \"leapt_steps\": 0,\n"
                 "    \"osnsp\": 0,\n"
                 "    \"pivots\": 0,\n"
                 "    \"factorizations\": 0,\n"
                 "    \"cache_hits\": 0,\n"
                 "    \"singular\": 0,\n"
                 "    \"cpu_s\": 0,\n"
                 "    \"wall_s\": 0\n"
                 "  },\n"
                 "  \"certificate\": {\"worst\": 0, \"time\": 0, \"where\": null, "
                 "\"wrong_sign\": 0},\n"
                 "  \"start\": {},\n"
                 "  \"final\": {},\n"
                 "  \"events\": [],\n"
                 "  \"jumps\": [],\n"
                 "  \"nonunique\": [],\n"
                 "  \"measurements\": []\n"
                 "}\n");
}

END_TEST

RUN_SUITE("report", test_everything, test_method_without_transient, test_nothing)
