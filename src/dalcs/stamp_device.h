/* stamp_device.h - the equations of single devices. Private to src/dalcs. */
#ifndef DALCS_STAMP_DEVICE_H
#define DALCS_STAMP_DEVICE_H

#include "stamp.h"

/* Stamps the entries of a device that need only its own nodes and columns. next_forest counts the
 * capacitors of the forest. */
enum dalcs_status dalcs_stamp_device(struct stamps *b, int device,
                                     int *next_forest) DALCS_MUST_CHECK;

/* -1 for a switch that closes when its control falls. */
double dalcs_stamp_control_sign(const struct dalcs_switch_model *m);

#endif
