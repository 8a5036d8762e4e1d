import { MODES, TOOLS } from "../tools/tools.js";

/**
 * Fill the rail of tools.
 * @param {HTMLElement} rail
 * @param {import("../stage.js").Stage} stage
 */
export function fillRail(rail, stage) {
  /** @type {[HTMLButtonElement, () => boolean][]} */
  const buttons = [];
  /**
   * @param {{key: string, label: string, icon: string, name: string}} told
   * @param {() => void} chosen
   * @param {() => boolean} isOn
   */
  const add = (told, chosen, isOn) => {
    const button = document.createElement("button");
    button.id = `tool-${told.name}`;
    button.title = `${told.label} (${told.key})`;
    button.innerHTML = `<svg viewBox="0 0 24 24" aria-hidden="true">${told.icon}</svg><kbd aria-hidden="true">${told.key}</kbd><span class="sr">${told.label}</span>`;
    button.addEventListener("click", chosen);
    buttons.push([button, isOn]);
    rail.append(button);
  };
  for (const tool of TOOLS) add(tool, () => stage.setTool(tool.name), () => stage.tool === tool.name);
  rail.append(document.createElement("hr"));
  for (const mode of MODES) add(mode, () => stage.setMode(mode.name), () => stage.mode === mode.name);
  const renew = () => {
    for (const [button, isOn] of buttons) button.setAttribute("aria-pressed", String(isOn()));
  };
  stage.watch(renew);
  renew();
}
