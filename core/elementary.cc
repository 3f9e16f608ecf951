#include "core/elementary.h"

#include <sleef.h>

namespace halocline::elementary {

namespace detail {

double exp_beyond(double x) { return Sleef_cinz_expd1_u10purec(x); }
double exp10_beyond(double x) { return Sleef_cinz_exp10d1_u10purec(x); }
double log_beyond(double x) { return Sleef_cinz_logd1_u10purec(x); }
double log2_beyond(double x) { return Sleef_cinz_log2d1_u10purec(x); }
double log10_beyond(double x) { return Sleef_cinz_log10d1_u10purec(x); }
double sin_beyond(double x) { return Sleef_cinz_sind1_u10purec(x); }
double cos_beyond(double x) { return Sleef_cinz_cosd1_u10purec(x); }

}  // namespace detail

double pow(double x, double y) { return Sleef_cinz_powd1_u10purec(x, y); }
double tan(double x) { return Sleef_cinz_tand1_u10purec(x); }
double asin(double x) { return Sleef_cinz_asind1_u10purec(x); }
double acos(double x) { return Sleef_cinz_acosd1_u10purec(x); }
double atan(double x) { return Sleef_cinz_atand1_u10purec(x); }
double atan2(double y, double x) { return Sleef_cinz_atan2d1_u10purec(y, x); }
double cosh(double x) { return Sleef_cinz_coshd1_u10purec(x); }
double acosh(double x) { return Sleef_cinz_acoshd1_u10purec(x); }
double atanh(double x) { return Sleef_cinz_atanhd1_u10purec(x); }
double expm1(double x) { return Sleef_cinz_expm1d1_u10purec(x); }
double log1p(double x) { return Sleef_cinz_log1pd1_u10purec(x); }
double cbrt(double x) { return Sleef_cinz_cbrtd1_u10purec(x); }
double erfc(double x) { return Sleef_cinz_erfcd1_u15purec(x); }
double lgamma(double x) { return Sleef_cinz_lgammad1_u10purec(x); }

}  // namespace halocline::elementary
