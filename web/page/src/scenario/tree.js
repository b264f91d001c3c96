/** Where the values of a scenario stand in its text: a YAML syntax tree, read along paths such as wall.contact.law. */
import { parser } from "@lezer/yaml";

const MAPPINGS = ["BlockMapping", "FlowMapping"];
const LISTS = ["BlockSequence", "FlowSequence"];

/** "wall.size[1]" as ["wall", "size", 1]. */
export function parts(path) {
  return [...path.matchAll(/([^.[\]]+)|\[(\d+)\]/g)].map(([, name, index]) => name ?? Number(index));
}

/** The syntax tree of a text. */
export function parsed(text) {
  return parser.parse(text);
}

/** The node of the whole document; null where there is none. */
export function root(tree) {
  return tree.topNode.getChild("Document")?.lastChild ?? null;
}

export function isMapping(node) {
  return Boolean(node) && MAPPINGS.includes(node.name);
}

export function isList(node) {
  return Boolean(node) && LISTS.includes(node.name);
}

/** The pairs of a mapping: key as text, node of the pair, node of the value or null. */
export function pairs(text, mapping) {
  return mapping.getChildren("Pair").map((node) => {
    const key = node.getChild("Key");
    const last = node.lastChild;
    const value = last && last.from >= key.to && !["Key", ":", "Comment"].includes(last.name) ? last : null;
    return { key: text.slice(key.from, key.to).trim(), node, value };
  });
}

/** The nodes of a list's items. */
export function items(list) {
  const found = [];
  for (let node = list.firstChild; node; node = node.nextSibling) {
    if (node.name === "Item") found.push(node.lastChild);
    else if (!["[", "]", ",", "Comment"].includes(node.name)) found.push(node);
  }
  return found;
}

/** The node of the value at a path; null where the text, whose tree is given, has none. */
export function find(text, tree, path) {
  let node = root(tree);
  for (const part of parts(path)) {
    if (typeof part === "number") node = isList(node) ? (items(node)[part] ?? null) : null;
    else node = isMapping(node) ? (pairs(text, node).find((pair) => pair.key === part)?.value ?? null) : null;
  }
  return node;
}
