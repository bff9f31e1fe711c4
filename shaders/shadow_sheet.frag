// shadow_sheet.frag — a shadow map knows yes and no: what is at least half
// opaque casts a shadow.

void main() {
  if (matter_opacity() < 0.5) discard;
}
