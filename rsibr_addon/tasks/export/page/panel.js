// The panel: a slider, box, menu or colour for each of the page's own settings and of the look's options.

class Panel {
  constructor(place) {
    this.place = place;
    this.resets = [];
  }

  row({ label, help }, control, place = this.place) {
    const row = document.createElement("label");
    const name = document.createElement("span");
    name.textContent = label;
    row.title = help || "";
    row.append(name, ...[control].flat());
    place.append(row);
  }

  input(type, value, changed, more = {}) {
    const input = Object.assign(document.createElement("input"), { type, ...more });
    const set = () => {
      input[type === "checkbox" ? "checked" : "value"] = value;
    };
    set();
    input.addEventListener("input", () => changed(type === "checkbox" ? input.checked : input.value));
    this.resets.push(() => {
      set();
      input.dispatchEvent(new Event("input"));
    });
    return input;
  }

  slider(told, least, most, start, changed, place) {
    const output = document.createElement("output");
    const digits = most - least > 50 ? 0 : 2;
    const show = (number) => {
      output.textContent = `${number.toFixed(digits)}${told.unit === "degrees" ? "°" : ""}`;
    };
    const input = this.input("range", start, (text) => {
      show(Number(text));
      changed(Number(text));
    }, { min: least, max: most, step: "any" });
    input.name = told.name;
    show(start);
    this.row(told, [input, output], place);
  }

  check(told, start, changed, place) {
    const input = this.input("checkbox", start, changed);
    input.name = told.name;
    this.row(told, input, place);
  }

  colour(told, start, changed, place) {
    const input = this.input("color", encoded(start), (text) => changed(decoded(text)));
    input.name = told.name;
    this.row(told, input, place);
  }

  menu(told, choices, start, changed, place) {
    const menu = document.createElement("select");
    menu.name = told.name;
    menu.append(...choices.map((choice) => new Option(choice)));
    menu.selectedIndex = start;
    menu.addEventListener("change", () => changed(menu.selectedIndex));
    this.resets.push(() => {
      menu.selectedIndex = start;
      changed(start);
    });
    this.row(told, menu, place);
  }

  // tasks/export/page/parameters.py
  parameter(told, block, changed, place) {
    const set = (components) => {
      components.forEach((component, number) => apply(told.sets[number], Number(component), block));
      changed();
    };
    const at = told.sets[0].at;
    const forms = {
      slider: () => this.slider(told, at[0], at[at.length - 1], told.start, (number) => set([number]), place),
      check: () => this.check(told, Boolean(told.start), (checked) => set([checked]), place),
      choice: () => this.menu(told, told.choices, told.start, (number) => set([number]), place),
      colour: () => this.colour(told, told.start, set, place),
    };
    forms[told.form]();
  }
}

// Sets a block's entries, linear between the numbers that were tried.
function apply({ at, entries, values }, number, block) {
  let next = at.findIndex((each) => each >= number);
  next = next < 0 ? at.length - 1 : Math.max(next, 1);
  const share = Math.min(Math.max((number - at[next - 1]) / (at[next] - at[next - 1]), 0), 1);
  entries.forEach((entry, place) => {
    block[entry] = (1 - share) * values[next - 1][place] + share * values[next][place];
  });
}

// Linear colours and those of a colour picker, in sRGB.
function encoded(colour) {
  const bytes = colour.map((linear) => {
    const curve = linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
    return Math.round(255 * Math.min(Math.max(curve, 0), 1)).toString(16).padStart(2, "0");
  });
  return `#${bytes.join("")}`;
}

function decoded(text) {
  return [1, 3, 5].map((place) => {
    const curve = parseInt(text.slice(place, place + 2), 16) / 255;
    return curve <= 0.04045 ? curve / 12.92 : ((curve + 0.055) / 1.055) ** 2.4;
  });
}
