/* pi.h - the number, once. */
#ifndef DALCS_PI_H
#define DALCS_PI_H

static const double dalcs_pi = 3.14159265358979323846;
static const double dalcs_two_pi = 6.28318530717958647693;

#endif
