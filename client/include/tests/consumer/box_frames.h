/* What a depth camera sees that walks through a room made of boxes; plain loops, for C and C++. */
#ifndef BOX_FRAMES_H
#define BOX_FRAMES_H
#include <math.h>
#include <stdint.h>

enum { FRAME_WIDTH = 160, FRAME_HEIGHT = 120, FRAME_COUNT = 30 };
#define FOCAL_PX 115.0
#define UNIT_M 0.001
#define STEP_M 0.02    /* per frame, along x */
#define TURN_RAD 0.008 /* per frame, about z */

static inline int64_t frame_stamp_ns(int frame) {
  return INT64_C(1700000000000000000) + frame * INT64_C(66666667);
}

/* Distance along a ray to where it leaves (or, from outside, enters) a box; negative: it misses. */
static inline double box_hit(const double low[3], const double high[3], const double from[3],
                             const double along[3]) {
  double enter = -1e9, leave = 1e9;
  for (int i = 0; i < 3; ++i) {
    double d = fabs(along[i]) < 1e-12 ? 1e-12 : along[i];
    double a = (low[i] - from[i]) / d, b = (high[i] - from[i]) / d;
    enter = fmax(enter, fmin(a, b));
    leave = fmin(leave, fmax(a, b));
  }
  if (enter > leave || leave < 0) return -1;
  return enter > 0 ? enter : leave;
}

static inline double nearest_hit(const double from[3], const double along[3]) {
  static const double boxes[4][2][3] = {{{0, 0, 0}, {6, 5, 2.7}},
                                        {{4.2, 3.1, 0}, {4.9, 3.7, 1.1}},
                                        {{5.3, 2.0, 0}, {6.0, 2.6, 1.8}},
                                        {{3.0, 4.5, 0}, {4.0, 5.0, 0.8}}};
  double best = 1e9;
  for (int b = 0; b < 4; ++b) {
    double hit = box_hit(boxes[b][0], boxes[b][1], from, along);
    if (hit > 0 && hit < best) best = hit;
  }
  return best;
}

/* The camera looks at a corner, a little downwards. */
static inline void render_frame(int frame, uint16_t* units) {
  const double yaw = 0.6 + frame * TURN_RAD, pitch = 0.25;
  const double from[3] = {1.8 + frame * STEP_M, 1.6, 1.2};
  const double ahead[3] = {cos(yaw) * cos(pitch), sin(yaw) * cos(pitch), -sin(pitch)};
  const double right[3] = {sin(yaw), -cos(yaw), 0};
  const double down[3] = {ahead[1] * right[2] - ahead[2] * right[1], ahead[2] * right[0] - ahead[0] * right[2],
                          ahead[0] * right[1] - ahead[1] * right[0]};
  for (int v = 0; v < FRAME_HEIGHT; ++v)
    for (int u = 0; u < FRAME_WIDTH; ++u) {
      double x = (u - (FRAME_WIDTH - 1) / 2.0) / FOCAL_PX, y = (v - (FRAME_HEIGHT - 1) / 2.0) / FOCAL_PX;
      double along[3];
      for (int i = 0; i < 3; ++i) along[i] = ahead[i] + x * right[i] + y * down[i];
      units[v * FRAME_WIDTH + u] = (uint16_t)lround(nearest_hit(from, along) / UNIT_M);
    }
}

static inline double walked_m(void) {
  return (FRAME_COUNT - 1) * STEP_M;
}
static inline double turned_rad(void) {
  return (FRAME_COUNT - 1) * TURN_RAD;
}

/* Of poses as both APIs give them. */
static inline double distance_m(const double a[3], const double b[3]) {
  return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}
static inline double angle_rad(const double p[4], const double q[4]) {
  return 2 * acos(fmin(1.0, fabs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3])));
}
#endif
