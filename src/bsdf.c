// bsdf.c

#include "bsdf.h"

#include "num.h"

void bsdf_basis(vec3 n, vec3 *t, vec3 *b) {
  float sign = copysignf(1, n.z);
  float a = -1 / (sign + n.z);
  float c = n.x * n.y * a;
  *t = (vec3){1 + sign * n.x * n.x * a, sign * c, -sign * n.x};
  *b = (vec3){c, sign + n.y * n.y * a, -n.y};
}

// In double precision, because R is infinitely steep at the critical angle:
// one rounding of the float argument's square is an error of 3e-4 in R there.
// s is eta cos_t, so that neither line divides by eta.
float fresnel_dielectric(float cos_i, float eta, float *cos_t) {
  double c = (double)cos_i, n = (double)eta;
  double s2 = (n - 1) * (n + 1) + c * c;
  *cos_t = 0;
  if (!(s2 > 0)) return 1;
  double s = sqrt(s2);
  *cos_t = (float)(s / n);
  double across = (c - s) / (c + s);
  double along = (n * n * c - s) / (n * n * c + s);
  return (float)(0.5 * (across * across + along * along));
}

float blinn_phong_norm(float n) {
  return (n + 2) * (n + 4) / (8 * PI * (num_exp2(-0.5f * n) + n));
}

// h.z^n for unit h.  Near the pole from t = sin^2, with log(1 - t) = -2
// atanh(t / (2 - t)): h.z itself is too coarse for a large exponent there (one
// ulp of it to the power 1e6 is 6 %).
static float cosine_power(vec3 h, float n) {
  float t = h.x * h.x + h.y * h.y;
  if (t >= 0.25f) return num_pow(h.z, n);
  float z = t / (2 - t), z2 = z * z;
  float atanh_z = z * (1 + z2 * (1.0f / 3 + z2 * (1.0f / 5 + z2 * (1.0f / 7))));
  return num_exp2(-n * 1.44269504f * atanh_z);
}

// 1 - u^p for u in (0, 1], without cancellation for small p.
static float one_minus_power(float u, float p) {
  float e = p * num_log2(u), x = -0.69314718f * e;
  if (x > 0.25f) return 1 - num_exp2(e);
  return x *
         (1 - x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6)))));
}

static float mean_of(vec3 c) {
  return (c.x + c.y + c.z) * (1.0f / 3);
}

// The probability of the specular lobe: its share of the colours.
static float specular_share(const bsdf *b) {
  float d = mean_of(b->kd), s = mean_of(b->ks);
  return s > 0 ? s / (d + s) : 0;
}

// Whether both directions are above the surface, where alone the non-delta
// lobes scatter.
static bool both_above(vec3 wo, vec3 wi) {
  return wo.z > 0 && wi.z > 0;
}

vec3 bsdf_eval(const bsdf *b, vec3 wo, vec3 wi) {
  if (b->kind == BSDF_ROUGH) return bsdf_rough_eval(&b->rough, wo, wi);
  if (bsdf_is_delta(b) || !both_above(wo, wi)) return vec3_all(0);
  vec3 f = vec3_scale(b->kd, 1 / PI);
  if (b->kind == BSDF_LAMBERT) return f;
  vec3 h = vec3_unit(vec3_add(wo, wi));
  return vec3_mad(f, blinn_phong_norm(b->ns) * cosine_power(h, b->ns), b->ks);
}

vec3 bsdf_eval_point(const bsdf *b, vec3 wo, vec3 wi) {
  if (b->kind != BSDF_ROUGH) return bsdf_eval(b, wo, wi);
  bsdf_rough under = bsdf_rough_under_point(&b->rough);
  return bsdf_rough_eval(&under, wo, wi);
}

float bsdf_pdf(const bsdf *b, vec3 wo, vec3 wi) {
  if (b->kind == BSDF_ROUGH) return bsdf_rough_pdf(&b->rough, wo, wi);
  if (bsdf_is_delta(b) || !both_above(wo, wi)) return 0;
  float diffuse = wi.z / PI;
  if (b->kind == BSDF_LAMBERT) return diffuse;
  vec3 h = vec3_unit(vec3_add(wo, wi));
  float density = (b->ns + 1) / (2 * PI) * cosine_power(h, b->ns);
  float specular = density / (4 * vec3_dot(wo, h));
  float share = specular_share(b);
  return share * specular + (1 - share) * diffuse;
}

// Cosine-weighted: a uniform disc projected up to the hemisphere (Malley's
// method).  u2 < 1 keeps z above 0.
static vec3 sample_cosine(float u1, float u2) {
  vec2 c = num_circle(u1);
  float r = sqrtf(u2);
  return (vec3){r * c.x, r * c.y, sqrtf(1 - u2)};
}

// wo mirrored in a half vector of density (n + 1) / 2 pi cos^n.
static vec3 sample_blinn_phong(float n, vec3 wo, float u1, float u2) {
  vec2 c = num_circle(u1);
  float sin2 = one_minus_power(1 - u2, 2 / (n + 1));
  float r = sqrtf(sin2);
  vec3 h = {r * c.x, r * c.y, sqrtf(float_max(0, 1 - sin2))};
  return vec3_sub(vec3_scale(h, 2 * vec3_dot(wo, h)), wo);
}

static bool sample_shiny(const bsdf *b, vec3 wo, float u, float u1, float u2,
                         bsdf_sample *out) {
  if (!(wo.z > 0)) return false;
  bool specular = b->kind == BSDF_BLINN_PHONG && u < specular_share(b);
  vec3 wi =
      specular ? sample_blinn_phong(b->ns, wo, u1, u2) : sample_cosine(u1, u2);
  float pdf = bsdf_pdf(b, wo, wi);
  if (!(pdf > 0)) return false;
  vec3 weight = vec3_scale(bsdf_eval(b, wo, wi), wi.z / pdf);
  *out = (bsdf_sample){.wi = wi, .weight = weight, .pdf = pdf};
  return true;
}

static bool sample_rough(const bsdf_rough *b, vec3 wo, const float u[3],
                         bsdf_sample *out) {
  bsdf_sample s = {.delta = false};
  if (!bsdf_rough_sample(b, wo, u, &s.wi, &s.weight)) return false;
  s.pdf = bsdf_rough_pdf(b, wo, s.wi);
  *out = s;
  return true;
}

static bool sample_mirror(const bsdf *b, vec3 wo, bsdf_sample *out) {
  if (!(wo.z > 0)) return false;
  vec3 weight = b->schlick ? fresnel_schlick(b->ks, wo.z) : b->ks;
  vec3 wi = {-wo.x, -wo.y, wo.z};
  *out = (bsdf_sample){.wi = wi, .weight = weight, .pdf = 1, .delta = true};
  return true;
}

// Reflects with probability R, else refracts.  What is carried is L / index^2,
// which a boundary does not change: no factor eta^2 here.
static bool sample_glass(const bsdf *b, vec3 wo, float u, bsdf_sample *out) {
  float eta = wo.z >= 0 ? b->eta : 1 / b->eta;
  float cos_t;
  float reflectance =
      fresnel_dielectric(float_min(fabsf(wo.z), 1), eta, &cos_t);
  *out = (bsdf_sample){.delta = true};
  if (u < reflectance) {
    out->wi = (vec3){-wo.x, -wo.y, wo.z};
    out->weight = vec3_all(1);
    out->pdf = reflectance;
  } else {
    float z = wo.z >= 0 ? -cos_t : cos_t;
    out->wi = vec3_unit((vec3){-wo.x / eta, -wo.y / eta, z});
    out->weight = b->kd;
    out->pdf = 1 - reflectance;
    out->transmitted = true;
  }
  return true;
}

bool bsdf_sample_wi(const bsdf *b, vec3 wo, float u, float u1, float u2,
                    bsdf_sample *out) {
  switch (b->kind) {
  case BSDF_MIRROR: return sample_mirror(b, wo, out);
  case BSDF_GLASS: return sample_glass(b, wo, u, out);
  case BSDF_ROUGH:
    return sample_rough(&b->rough, wo, (float[]){u, u1, u2}, out);
  case BSDF_LAMBERT:
  case BSDF_BLINN_PHONG: break;
  }
  return sample_shiny(b, wo, u, u1, u2, out);
}

bool bsdf_is_delta(const bsdf *b) {
  return b->kind == BSDF_MIRROR || b->kind == BSDF_GLASS;
}
