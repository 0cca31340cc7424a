/* argument_values.h - the value of each option of `dalcs run`, into *arguments or a message and DALCS_E_OPTION. Text
 * is borrowed. */
#ifndef DALCS_ARGUMENT_VALUES_H
#define DALCS_ARGUMENT_VALUES_H

#include "arguments.h"

/* Is it the name of a page of HTML? */
bool dalcs_argument_is_page(const char *path);

enum dalcs_status dalcs_argument_output(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli,
                                        const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_method(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli,
                                        const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_tolerance(struct dalcs_arguments *arguments,
                                           const struct dalcs_cli *cli,
                                           const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_stages(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli,
                                        const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_step(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli,
                                      const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_fill(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli,
                                      const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_curve(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli,
                                       const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_at(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                    const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_tran(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli,
                                      const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_tstop(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli,
                                       const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_compress(struct dalcs_arguments *arguments,
                                          const struct dalcs_cli *cli,
                                          const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_audit(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli,
                                       const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_bifurcation(struct dalcs_arguments *arguments,
                                             const struct dalcs_cli *cli,
                                             const char *path) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_samples(struct dalcs_arguments *arguments,
                                         const struct dalcs_cli *cli,
                                         const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_settle(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli,
                                        const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_multipliers_plot(struct dalcs_arguments *arguments,
                                                  const struct dalcs_cli *cli,
                                                  const char *path) DALCS_MUST_CHECK;
/* Has no text. */
enum dalcs_status dalcs_argument_sensitivity(struct dalcs_arguments *arguments,
                                             const struct dalcs_cli *cli,
                                             const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_period(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli,
                                        const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_stop(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli,
                                      const char *text) DALCS_MUST_CHECK;
/* T,T,... */
enum dalcs_status dalcs_argument_show(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli,
                                      const char *text) DALCS_MUST_CHECK;
/* FROM:TO, either of which may be left out; NULL: the netlist's window. */
enum dalcs_status dalcs_argument_losses(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli,
                                        const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_losses_plot(struct dalcs_arguments *arguments,
                                             const struct dalcs_cli *cli,
                                             const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_plot(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli,
                                      const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_shard(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli,
                                       const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_measures(struct dalcs_arguments *arguments,
                                          const struct dalcs_cli *cli,
                                          const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_seed(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli,
                                      const char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_argument_set(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                     const char *text) DALCS_MUST_CHECK;

#endif
