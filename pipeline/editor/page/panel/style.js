import { section } from "./rows.js";
import { specOf, styleForm } from "./style_form.js";

/**
 * @typedef {import("../stage.js").Stage} Stage
 * @typedef {Record<string, import("./style_form.js").Style>} Styles
 * @typedef {{name: string, values: Record<string, any>, isOpen: boolean}} Layer
 */

/** Styles over one another, as the registry tells of them. */
export class StylePanel {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {Styles} */
    this.styles = {};
    /** @type {Layer[]} from top to bottom */
    this.layers = [];
    this.list = document.createElement("ol");
    this.list.className = "layers";
    this.add = document.createElement("select");
    this.add.id = "add-style";
    this.add.setAttribute("aria-label", "Add a style on top");
    this.add.addEventListener("change", () => this.put(this.add.value));
    this.element = section("Style", this.list, this.add);
    this.isSending = false;
    this.isWanted = false;
  }

  /**
   * @param {Styles} styles
   * @param {string} usual the style that is drawn if none is chosen
   */
  fill(styles, usual) {
    if (this.layers.length) return;
    this.styles = styles;
    this.add.replaceChildren(new Option("Add a style on top…", ""), ...Object.keys(styles).map((name) => new Option(name, name)));
    this.layers = [{ name: usual, values: {}, isOpen: false }];
    this.renew();
  }

  /** @param {string} name */
  put(name) {
    this.add.value = "";
    if (name) this.lay(name, {});
  }

  /**
   * Lay a style over the others.
   * @param {string} name
   * @param {Record<string, any>} values
   */
  lay(name, values) {
    for (const layer of this.layers) layer.isOpen = false;
    this.layers.unshift({ name, values, isOpen: true });
    this.changed();
  }

  /** The stack as the command line takes it, bottom to top. */
  get specs() {
    return this.layers.map(({ name, values }) => specOf(name, values)).reverse();
  }

  changed() {
    this.renew();
    this.send();
  }

  /** Have the newest stack drawn; of those between the last counts. */
  async send() {
    this.stage.veil(true);
    this.isWanted = true;
    if (this.isSending) return;
    this.isSending = true;
    while (this.isWanted) {
      this.isWanted = false;
      try {
        await this.stage.connection.ask("style", { styles: this.specs });
      } catch (error) {
        this.stage.told.problem(/** @type {Error} */ (error).message);
      }
    }
    this.isSending = false;
    this.stage.renewCommands();
  }

  renew() {
    this.list.replaceChildren(...this.layers.map((layer, place) => this.row(layer, place)));
  }

  /**
   * @param {Layer} layer
   * @param {number} place
   */
  row(layer, place) {
    const row = document.createElement("li");
    row.draggable = true;
    row.dataset.style = layer.name;
    const head = document.createElement("div");
    const open = document.createElement("button");
    open.textContent = layer.name;
    open.title = `${this.styles[layer.name]?.summary ?? ""} (Alt + arrows move it)`;
    open.setAttribute("aria-expanded", String(layer.isOpen));
    open.addEventListener("click", () => {
      layer.isOpen = !layer.isOpen;
      this.renew();
    });
    open.addEventListener("keydown", (event) => {
      const by = event.altKey ? { ArrowUp: -1, ArrowDown: 1 }[event.key] : undefined;
      if (by) this.move(place, place + by);
    });
    const away = document.createElement("button");
    away.innerHTML = `×<span class="sr">Take ${layer.name} away</span>`;
    away.disabled = this.layers.length < 2;
    away.addEventListener("click", () => {
      this.layers.splice(place, 1);
      this.changed();
    });
    head.append(open, away);
    row.append(head);
    if (layer.isOpen) row.append(...styleForm(this.styles[layer.name], layer.values, "style", () => this.send()));
    row.addEventListener("dragstart", (event) => event.dataTransfer?.setData("text/plain", String(place)));
    row.addEventListener("dragover", (event) => event.preventDefault());
    row.addEventListener("drop", (event) => {
      event.preventDefault();
      this.move(Number(event.dataTransfer?.getData("text/plain")), place);
    });
    return row;
  }

  /**
   * @param {number} from
   * @param {number} to
   */
  move(from, to) {
    if (!(from in this.layers) || !(to in this.layers) || from === to) return;
    const [layer] = this.layers.splice(from, 1);
    this.layers.splice(to, 0, layer);
    this.changed();
  }
}
