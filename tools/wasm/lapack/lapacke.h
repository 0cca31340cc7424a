/* lapacke.h - the functions of LAPACK that libdalcs calls, for a build without Fortran.
 *
 * Arguments and answers are those of LAPACKE; what each function leaves out is written at its definition. Meant for
 * the matrices of a circuit that a person draws, up to some hundred rows: nothing is blocked. */
#ifndef DALCS_WASM_LAPACKE_H
#define DALCS_WASM_LAPACKE_H

#include <complex.h>

typedef int lapack_int;
typedef double _Complex lapack_complex_double;

#define LAPACK_ROW_MAJOR              101
#define LAPACK_COL_MAJOR              102
#define LAPACK_WORK_MEMORY_ERROR      (-1010)
#define LAPACK_TRANSPOSE_MEMORY_ERROR (-1011)

/* ---- factor.c: triangular factors ---- */

lapack_int LAPACKE_dgetrf(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda,
                          lapack_int *pivot);
lapack_int LAPACKE_dgetrs(int layout, char trans, lapack_int n, lapack_int n_right, const double *a,
                          lapack_int lda, const lapack_int *pivot, double *b, lapack_int ldb);
lapack_int LAPACKE_dgesv(int layout, lapack_int n, lapack_int n_right, double *a, lapack_int lda,
                         lapack_int *pivot, double *b, lapack_int ldb);
lapack_int LAPACKE_dgecon(int layout, char norm, lapack_int n, const double *a, lapack_int lda,
                          double anorm, double *rcond);
lapack_int LAPACKE_zgesv(int layout, lapack_int n, lapack_int n_right, lapack_complex_double *a,
                         lapack_int lda, lapack_int *pivot, lapack_complex_double *b,
                         lapack_int ldb);
lapack_int LAPACKE_dpotrf(int layout, char uplo, lapack_int n, double *a, lapack_int lda);
lapack_int LAPACKE_dpstrf(int layout, char uplo, lapack_int n, double *a, lapack_int lda,
                          lapack_int *pivot, lapack_int *rank, double tol);

/* ---- jacobi.c: symmetric eigenvalues and singular values by rotations ---- */

lapack_int LAPACKE_zheev(int layout, char job, char uplo, lapack_int n, lapack_complex_double *a,
                         lapack_int lda, double *value);
lapack_int LAPACKE_dsyev(int layout, char job, char uplo, lapack_int n, double *a, lapack_int lda,
                         double *value);
lapack_int LAPACKE_dsyevd(int layout, char job, char uplo, lapack_int n, double *a, lapack_int lda,
                          double *value);
lapack_int LAPACKE_dgesvd(int layout, char job_u, char job_vt, lapack_int m, lapack_int n,
                          double *a, lapack_int lda, double *s, double *u, lapack_int ldu,
                          double *vt, lapack_int ldvt, double *superb);
lapack_int LAPACKE_dgesdd(int layout, char job, lapack_int m, lapack_int n, double *a,
                          lapack_int lda, double *s, double *u, lapack_int ldu, double *vt,
                          lapack_int ldvt);
lapack_int LAPACKE_dgelss(int layout, lapack_int m, lapack_int n, lapack_int n_right, double *a,
                          lapack_int lda, double *b, lapack_int ldb, double *s, double rcond,
                          lapack_int *rank);

/* ---- eigen.c: eigenvalues of any matrix ---- */

lapack_int LAPACKE_dgebal(int layout, char job, lapack_int n, double *a, lapack_int lda,
                          lapack_int *low, lapack_int *high, double *scale);
lapack_int LAPACKE_dgeev(int layout, char job_left, char job_right, lapack_int n, double *a,
                         lapack_int lda, double *re, double *im, double *left, lapack_int ld_left,
                         double *right, lapack_int ld_right);

#endif
