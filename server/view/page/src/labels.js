// Names beside what they name, as text over the canvas.
export class Labels {
  /// `pixelOf(place)`: where a place is seen, or null.
  constructor(parent, pixelOf) {
    this.parent = parent;
    this.pixelOf = pixelOf;
    this.held = new Map();
  }

  /// Those of {text, kind, place}, and no others.
  show(wanted) {
    const keys = new Set(wanted.map(({ text, kind }) => `${kind} ${text}`));
    for (const [key, label] of this.held) {
      if (keys.has(key)) continue;
      label.remove();
      this.held.delete(key);
    }
    for (const { text, kind, place } of wanted) this.put(text, kind, place);
  }

  put(text, kind, place) {
    const key = `${kind} ${text}`;
    if (!this.held.has(key)) {
      const label = document.createElement('span');
      label.className = kind;
      label.textContent = text;
      this.parent.append(label);
      this.held.set(key, label);
    }
    const at = this.pixelOf(place), label = this.held.get(key);
    label.hidden = !at;
    if (at) label.style.transform = `translate(${at[0] + 10}px, ${at[1] - 10}px)`;
  }
}
