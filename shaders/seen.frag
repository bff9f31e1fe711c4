// seen.frag — the number of the triangle, and 1.

uniform int u_first;  // the first of this call

out uint out_seen;

void main() {
  out_seen = uint(u_first + gl_PrimitiveID) + 1u;
}
