/** What the JSON Schema of scenarios says of a key: meaning, unit, range, choices. */
import { parts } from "../scenario/tree.js";

/** { description, unit, usual (how far people vary it), minimum, maximum, integer, choices, switch } of the key at a path of a resolved scenario. */
export function keyOf(schema, resolved, path) {
  let node = schema;
  let value = resolved;
  for (const part of parts(path)) {
    if (typeof part === "number") continue; // the items of a list share what the list says
    node = property(schema, node, value, part);
    value = value?.[part];
    if (!node) return described(schema, {}); // a key that the schema does not have
  }
  return described(schema, node);
}

function property(schema, node, value, name) {
  const found = allOf(schema, node, value).map((one) => one.properties?.[name]).filter((one) => one && one !== true);
  return found.length > 0 ? followed(schema, found[found.length - 1]) : null;
}

/** A schema and the parts of it that hold for a value. */
function allOf(schema, node, value) {
  const rest = (node.allOf ?? []).flatMap((one) => {
    const branch = one.if ? (holds(one.if, value) ? one.then : one.else) : one;
    return branch ? allOf(schema, branch, value) : [];
  });
  return [node, ...rest];
}

function holds(condition, value) {
  const needed = (condition.required ?? []).every((name) => value?.[name] !== undefined && value[name] !== null);
  return needed && Object.entries(condition.properties ?? {}).every(([name, rule]) => {
    const item = value?.[name];
    if (item === undefined || item === null) return true;
    if (rule.enum) return rule.enum.includes(item);
    return rule.properties ? holds(rule, item) : true;
  }); // prettier-ignore
}

function followed(schema, node) {
  return node.$ref ? { ...schema.definitions[node.$ref.slice("#/definitions/".length)], ...node } : node;
}

function described(schema, node) {
  const one = numeric(node);
  return {
    description: (node.description ?? "").replace(/ \[[^\]]*\]$/, ""), // its unit stands beside
    unit: node["x-unit"] ?? "",
    usual: { ...schema["x-range"], ...node["x-range"] },
    minimum: one.exclusiveMinimum ?? one.minimum ?? -Infinity,
    open: "exclusiveMinimum" in one,
    maximum: one.maximum ?? Infinity,
    integer: one.type === "integer",
    choices: node.enum ?? null,
    isSwitch: node.type === "boolean",
  };
}

/** The part of a schema that speaks of a number, be it an item of a list or one of several forms. */
function numeric(node) {
  if (node.type === "number" || node.type === "integer") return node;
  if (node.items) return numeric(node.items);
  return (node.anyOf ?? []).map(numeric).find((one) => one.type) ?? {};
}
